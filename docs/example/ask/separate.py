"""A contestant in Python (docs/ask.md). Replace meets() by a call of your library."""
import sys


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def meets(a, b):
    """False if one of 17 directions separates the triangles, in rounded doubles."""
    ea, eb = ([[q - p for p, q in zip(t[i - 1], t[i])] for i in range(3)] for t in (a, b))
    na, nb = cross(ea[0], ea[1]), cross(eb[0], eb[1])
    directions = [na, nb, *(cross(na, u) for u in ea), *(cross(nb, v) for v in eb)] + [cross(u, v) for u in ea for v in eb]
    for d in directions:
        on_a, on_b = ([sum(x * y for x, y in zip(d, p)) for p in t] for t in (a, b))
        if max(on_a) < min(on_b) or max(on_b) < min(on_a):
            return False
    return True


CARD = ['card\tname\tseparate-py', 'card\tlibrary\tan example', 'card\tanswers\tpair', 'done']

for line in sys.stdin:
    number, question, *fields = line.rstrip('\n').split('\t')
    answers = ['refused\tit answers pairs alone']
    if question == 'card':
        answers = CARD
    if question == 'pair':
        corners = [[float(x) for x in fields[i:i + 3]] for i in range(1, 19, 3)]  # fields[0]: shared corners
        answers = ['1' if meets(corners[:3], corners[3:]) else '0']
    print('\n'.join(f'{number}\t{answer}' for answer in answers), flush=True)
