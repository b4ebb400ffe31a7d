// SPDX-License-Identifier: MIT
// Smooth surfaces from grids of numbers: uniform cubic B-splines that end at the ends of the grid.

// Weights of four neighbours at fine point i, with `times` points per cell, and the index of the first; indices -1 and
// n are possible.
function weights(n, times) {
    const fine = (n - 1) * times + 1;
    const table = [];
    for (let i = 0; i < fine; i++) {
        const cell = Math.min(Math.floor(i / times), n - 2);
        const t = i / times - cell;
        const t2 = t * t;
        const t3 = t2 * t;
        const w = [
            (1 - 3 * t + 3 * t2 - t3) / 6,
            (4 - 6 * t2 + 3 * t3) / 6,
            (1 + 3 * t + 3 * t2 - 3 * t3) / 6,
            t3 / 6,
        ];
        const each = new Float32Array(n);
        for (let k = 0; k < 4; k++) {
            const at = cell - 1 + k;
            // the grid is extended linearly beyond its ends
            if (at < 0) {
                each[0] += 2 * w[k];
                each[1] -= w[k];
            } else if (at >= n) {
                each[n - 1] += 2 * w[k];
                each[n - 2] -= w[k];
            } else each[at] += w[k];
        }
        let first = Math.max(0, Math.min(cell - 1, n - 4));
        table.push({ first, w: Array.from({ length: 4 }, (_, k) => each[first + k] ?? 0) });
    }
    return table;
}

/** Interpolates n*n numbers to fine*fine numbers. */
export class Upsampler {
    constructor(n, times) {
        this.n = n;
        this.fine = (n - 1) * times + 1;
        this.table = weights(n, times);
        this.rows = new Float32Array(this.fine * n);
    }

    /** get(i, j) → number; out[i + fine j] */
    run(get, out) {
        const { n, fine, table, rows } = this;
        for (let j = 0; j < n; j++)
            for (let i = 0; i < fine; i++) {
                const { first: f, w } = table[i];
                rows[i + fine * j] =
                    w[0] * get(f, j) + w[1] * get(f + 1, j) + w[2] * get(f + 2, j) + w[3] * get(f + 3, j);
            }
        for (let j = 0; j < fine; j++) {
            const { first, w } = table[j];
            const f = first * fine;
            for (let i = 0; i < fine; i++)
                out[i + fine * j] =
                    w[0] * rows[f + i] +
                    w[1] * rows[f + fine + i] +
                    w[2] * rows[f + 2 * fine + i] +
                    w[3] * rows[f + 3 * fine + i];
        }
    }
}

/** Normals of an indexed mesh, weighted by area. */
export function smoothNormals(x, index, out) {
    out.fill(0);
    for (let t = 0; t < index.length; t += 3) {
        const a = 3 * index[t];
        const b = 3 * index[t + 1];
        const c = 3 * index[t + 2];
        const ux = x[b] - x[a];
        const uy = x[b + 1] - x[a + 1];
        const uz = x[b + 2] - x[a + 2];
        const vx = x[c] - x[a];
        const vy = x[c + 1] - x[a + 1];
        const vz = x[c + 2] - x[a + 2];
        const nx = uy * vz - uz * vy;
        const ny = uz * vx - ux * vz;
        const nz = ux * vy - uy * vx;
        for (const p of [a, b, c]) {
            out[p] += nx;
            out[p + 1] += ny;
            out[p + 2] += nz;
        }
    }
    for (let i = 0; i < out.length; i += 3) {
        const size = Math.hypot(out[i], out[i + 1], out[i + 2]) || 1;
        out[i] /= size;
        out[i + 1] /= size;
        out[i + 2] /= size;
    }
}
