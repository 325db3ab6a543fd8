"""Lets Coq's kernel check the proofs that Gappa finds for the rows of docs/proofs.md. Gappa writes each proof as a Coq file. It
leaves the steps of the script (a formula is the same polynomial as another) as hypotheses; here each becomes a lemma that Coq
proves. Two twins of each row must be refused: larger rounding errors, and a step that is no identity. tests/coq.sh calls it.
  gappa.py FARCULL_PROOFS FOLDER [ROW...]   all rows, or these; writes its files into FOLDER
FARCULL_GAPPA_LIMIT: seconds of CPU for a proof, 120 by default. Rows that take longer are named, and are no
failure; so are those with steps that Gappa's library for Coq does not have."""
import os
import re
import resource
import signal
import subprocess
import sys

LIMIT = int(os.environ.get('FARCULL_GAPPA_LIMIT', '120'))
# Those of the reals, and the excluded middle, by which Flocq defines a rounding to integers.
AXIOMS = re.compile(r'ClassicalDedekindReals\.sig_(forall|not)_dec|FunctionalExtensionality\.functional_extensionality_dep|'
                    r'Classical_Prop\.classic')
STEP = re.compile(r'^Hypothesis (\w+) : (.*?)\.$', re.MULTILINE | re.DOTALL)
# Numbers of Gappa are an integer times a power of two.
LEMMA = '''Lemma \\1 : \\2.
Proof. unfold Float1, float2R; simpl; ring || field. Qed.'''


def output(words, text=None):
    done = subprocess.run(words, input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def accepted(folder, name, text):
    """Whether Coq accepts the text as a proof with no other axioms, and why not; None if it cannot be tried."""
    name = re.sub('[^a-z0-9_]', '_', name)
    with open(f'{folder}/{name}.v', 'w', encoding='utf-8') as file:
        file.write(text)
    status, said, wrong = output(['prlimit', f'--cpu={LIMIT}', 'coqc', '-q', '-w', 'none', f'{folder}/{name}.v'])
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return None, 'takes longer'
    if 'UNKNOWN_' in wrong:
        return None, "Gappa's library for Coq has not all of its steps"
    axioms = re.findall(r'^([^\s:]+)', said.split('Axioms:\n')[-1], re.MULTILINE) if 'Axioms:' in said else []
    others = [axiom for axiom in axioms if not AXIOMS.fullmatch(axiom)]
    return status == 0 and 'Axioms:' in said and not others, wrong[-300:] or f'axioms: {others}'


def check(script, folder, row):
    status, text, wrong = output(['gappa', '-Bcoq', '-Eprecision=200', '-Eno-auto-dichotomy'], script)
    if status:
        return False, f'gappa: {wrong[:300]}', 0
    text = text.replace('Require Import Gappa.Gappa_library.', 'From Coq Require Import Reals.\nRequire Import Gappa.Gappa_library.')
    proof = STEP.sub(LEMMA, text) + '\nPrint Assumptions l1.\n'
    start = seconds()
    good, why = accepted(folder, row, proof)
    spent = seconds() - start
    if not good:
        return good, why, spent
    twins = [STEP.sub(LEMMA, STEP.sub(r'Hypothesis \1 : \2 + 1.', text, count=1))] if STEP.search(text) else []
    unit = re.search(r'Float2 \(1\) \((-53|-24|-23)\)', proof)
    if unit:
        twins.append(proof.replace(unit[0], 'Float2 (1) (-12)'))
    for number, twin in enumerate(twins):
        if accepted(folder, f'{row}_twin_{number}', twin)[0]:
            return False, f'twin {number} is accepted as well', spent
    return True, f'{len(twins)} twins refused', spent


def main(proofs, folder, *rows):
    os.makedirs(folder, exist_ok=True)
    page = open('docs/proofs.md', encoding='utf-8').read()
    table = re.findall(r'^\| `([a-z_]+\.[a-z0-9_]+)` \|', page, re.MULTILINE)
    results, scripts = {True: [], False: [], None: []}, {}
    for row in rows or table:
        script = output([proofs, 'script', row])[1]
        # One script may prove several constants.
        if script not in scripts:
            scripts[script] = check(script, folder, row)
        good, why, spent = scripts[script]
        results[good].append(row)
        print(f'gappa: {row}: {"checked" if good else "REFUSED" if good is False else "not checked"} in {spent:.0f} s, {why}', flush=True)
    print(f'gappa: Coq has checked {len(results[True])} of {len(rows or table)} rows, refused {results[False]}, '
          f'left out {results[None]}')
    return bool(results[False]) or not results[True]


sys.exit(main(*sys.argv[1:]))
