// A contestant in JavaScript (docs/ask.md). Replace meets() by a call of your library.
'use strict';
const fs = require('fs');

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// False if one of 17 directions separates the triangles, in rounded doubles.
function meets(a, b) {
  const edges = (t) => t.map((p, i) => t[(i + 1) % 3].map((x, k) => x - p[k]));
  const ea = edges(a), eb = edges(b), na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
  const directions = [na, nb, ...ea.flatMap((u) => eb.map((v) => cross(u, v))), ...ea.map((u) => cross(na, u)),
    ...eb.map((u) => cross(nb, u))];
  return !directions.some((d) => {
    const onA = a.map((p) => dot(d, p)), onB = b.map((p) => dot(d, p));
    return Math.max(...onA) < Math.min(...onB) || Math.max(...onB) < Math.min(...onA);
  });
}

const card = ['card\tname\tseparate-js', 'card\tlibrary\tan example', 'card\tanswers\tpair', 'done'];

require('readline').createInterface({ input: process.stdin }).on('line', (line) => {
  const [number, question, ...fields] = line.split('\t');
  let answers = ['refused\tit answers pairs alone'];
  if (question === 'card') answers = card;
  if (question === 'pair') {  // fields[0]: shared corners
    const corners = [1, 4, 7, 10, 13, 16].map((i) => fields.slice(i, i + 3).map(Number));
    answers = [meets(corners.slice(0, 3), corners.slice(3)) ? '1' : '0'];
  }
  fs.writeSync(1, answers.map((answer) => `${number}\t${answer}\n`).join(''));
});
