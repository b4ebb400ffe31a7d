#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Computes the coefficients of SRKN6 from the 15 digits of the paper, and compares those in src/ with them.

The order conditions of a Nystrom method have the form  sum b_i Phi_i(tree) = kappa/order  for each tree up to order 6; see
Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.14. For a symmetric composition of kicks
and drifts, six of them are independent once sum a_i = sum b_i = 1. Newton's method with the shortest step solves these six.
"""
import re
import sys
from decimal import Decimal, getcontext
from pathlib import Path

getcontext().prec = 60
PAPER_B = ["0.0414649985182624", "0.198128671918067", "-0.0400061921041533", "0.0752539843015807", "-0.0115113874206879"]
PAPER_A = ["0.123229775946271", "0.290553797799558", "-0.127049212625417", "-0.246331761062075", "0.357208872795928"]


def whole(unknown):
    """All kicks and drifts of a step."""
    b, a = list(unknown[:5]), list(unknown[5:])
    b.append((1 - 2 * sum(b)) / 2)
    a.append(1 - 2 * sum(a))
    return b + b[::-1], a + a[-2::-1]


def conditions(unknown):
    """The residual of each order condition; the six independent ones come first."""
    b, a = whole(unknown)
    c = [sum(a[:i], Decimal(0)) for i in range(12)]

    def tree(*children):
        """Phi_i, kappa and order of a tree with these subtrees; None is an edge to a velocity."""
        phi, kappa, order = [Decimal(1)] * 12, Decimal(1), 1
        for child in children:
            if child is None:
                phi, order = [p * at for p, at in zip(phi, c)], order + 1
                continue
            inner, factor, size = child
            sums = [sum((b[j] * (c[i] - c[j]) * inner[j] for j in range(i)), Decimal(0)) for i in range(12)]
            phi, kappa, order = [p * s for p, s in zip(phi, sums)], kappa * factor / (size * (size + 1)), order + 1 + size
        return phi, kappa, order

    leaf, v = tree(), None
    chain = tree(v)
    trees = [tree(v, v), tree(leaf), tree(v, v, v, v), tree(v, v, leaf), tree(v, chain), tree(tree(leaf)),
             leaf, chain, tree(v, v, v), tree(v, leaf), tree(chain), tree(tree(v, v)), tree(leaf, leaf),
             tree(v, v, v, v, v), tree(v, v, v, leaf), tree(v, leaf, leaf), tree(v, v, chain), tree(leaf, chain),
             tree(v, tree(v, v)), tree(v, tree(leaf)), tree(tree(v, v, v)), tree(tree(v, leaf)), tree(tree(chain))]
    return [sum(x * y for x, y in zip(b, phi)) - kappa / order for phi, kappa, order in trees]


def solve(matrix, right):
    """Gaussian elimination with pivoting."""
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(n):
            if i != k:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def newton_step(unknown):
    difference = Decimal(10) ** -25
    residual = conditions(unknown)[:6]
    columns = []
    for k in range(len(unknown)):
        up, down = list(unknown), list(unknown)
        up[k] += difference
        down[k] -= difference
        columns.append([(x - y) / (2 * difference) for x, y in zip(conditions(up)[:6], conditions(down)[:6])])
    square = [[sum(column[i] * column[j] for column in columns) for j in range(6)] for i in range(6)]
    weight = solve(square, residual)
    return [x - sum(w * d for w, d in zip(weight, column)) for x, column in zip(unknown, columns)]


def stored(name, text):
    numbers = re.search(rf"srkn6_{name}\[\w+\] = {{(.*?)}};", text, re.DOTALL).group(1)
    return [Decimal(number) for number in numbers.replace("\n", " ").split(",")]


def main():
    paper = [Decimal(digits) for digits in PAPER_B + PAPER_A]
    unknown = paper
    for _ in range(4):
        unknown = newton_step(unknown)
    worst = max(abs(residual) for residual in conditions(unknown))
    moved = max(abs(x - y) for x, y in zip(unknown, paper))
    b, a = whole(unknown)
    c = [sum(a[: i + 1]) for i in range(11)]
    for i in range(6):
        print(f"b{i + 1}  {b[i]:+.36f}   a{i + 1}  {a[i]:+.36f}")
    print(f"largest residual {worst:.1e}, largest difference from the paper {moved:.1e}")
    text = (Path(__file__).resolve().parents[2] / "src/methods/srkn6_coefficients.h").read_text()
    wrong = max(abs(x - y) for name, want in (("b", b), ("a", a), ("c", c)) for x, y in zip(stored(name, text), want))
    print(f"largest error of a stored number {wrong:.1e}")
    return 0 if worst < Decimal("1e-50") and moved < Decimal("1e-15") and wrong < Decimal("1e-24") else 1


if __name__ == "__main__":
    sys.exit(main())
