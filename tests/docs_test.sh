#!/usr/bin/env bash
# Checks the paper (docs/reliability.md, then docs/budget.md) and what refers to it: numbers of definitions, lemmas, theorems and
# corollaries; sections of pages that are named in quotes; names of tests; citations; symbols;
# the files of a release (docs/extending.md).
#   tests/docs_test.sh [ROOT]      checks ROOT (default: this repository). It prints one line for each violation, and then exits
#                                  with status 1.
#   tests/docs_test.sh --self-test breaks each rule in a copy and checks that this is reported
exec python3 "${BASH_SOURCE[0]%.sh}.py" "$@"
