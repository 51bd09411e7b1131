// Poses as {p, q: [w, x, y, z]}, for tests that lead a hand.

export const multiply = (a, b) => [
  a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
  a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
  a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
  a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
];

export const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];

export const rotate = (q, [x, y, z]) => multiply(multiply(q, [0, x, y, z]), conjugate(q)).slice(1);

export const compose = (a, b) => ({ p: rotate(a.q, b.p).map((v, k) => v + a.p[k]), q: multiply(a.q, b.q) });

export const inverse = ({ p, q }) => ({ p: rotate(conjugate(q), p).map((v) => -v), q: conjugate(q) });
