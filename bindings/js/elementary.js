// SPDX-License-Identifier: MIT
// The functions of src/simd/elementary_tmpl.h that the exact solution needs, with the same operations in the same order. Only
// + - * / and Math.sqrt are used, which ECMAScript defines to the last bit. Math.exp and Math.sin differ between engines.

export const { abs, ceil, log2, max, min, PI, sqrt } = Math;

export const epsilon = Number.EPSILON; // 2^-52
const toInteger = 1.5 / epsilon; // 1.5 * 2^52: adding it leaves the nearest integer in the lowest bits

export const nearest = (a) => a + toInteger - toInteger;

/** 2^k of an integer, |k| < 1087. Each product is exact. */
export function powerOfTwo(k) {
    let power = 1;
    let factor = k < 0 ? 0.5 : 2;
    for (k = abs(k); k > 0; k >>= 1, factor *= factor) if (k & 1) power *= factor;
    return power;
}

export const leastNormal = powerOfTwo(-1022);

/** a 2^k, exact where the result is normal, else rounded once: ldexp() in C, for a of 1e-300 or more where k < 0. */
export function scaled(a, k) {
    const half = k >> 1;
    return a * powerOfTwo(half) * powerOfTwo(k - half);
}

/** The upper 26 bits of a. */
function upper(a) {
    const c = 134217729 * a; // 2^27 + 1
    return c - (c - a);
}

/** a b - product, where product is a b rounded: exactly, for numbers of 2^-450 to 2^450. */
export function productError(a, b, product) {
    const aHigh = upper(a);
    const aLow = a - aHigh;
    const bHigh = upper(b);
    const bLow = b - bHigh;
    return aHigh * bHigh - product + aHigh * bLow + aLow * bHigh + aLow * bLow;
}

const inverse = [1]; // 1/n! of factorials that are exact
for (let n = 1, factorial = 1; n < 19; n++) inverse[n] = 1 / (factorial *= n);

/** 1/first! + z/(first + step)! + ... + z^k/last!, an even number of terms, by Horner's rule for even and odd powers. */
function taylor(z, first, step, last) {
    const square = z * z;
    let even = inverse[last - step];
    let odd = inverse[last];
    for (let n = last - 2 * step; n > first; n -= 2 * step) {
        even = even * square + inverse[n - step];
        odd = odd * square + inverse[n];
    }
    return even + odd * z;
}

/** The k and e of e^x = 2^k (1 + e), |x| <= 1500. */
export function exponential(x) {
    const k = nearest(x * Math.LOG2E);
    const r = x - k * 0.6931471806019545 - k * -4.2009150726810846e-11; // ln 2 in two parts
    return [k, r + r * r * taylor(r, 2, 1, 13)];
}

/** The sine and the cosine. */
export function sineCosine(angle) {
    const known = abs(angle) < 0.5 / epsilon ? angle : angle - angle;
    const q = nearest(known * (2 / PI));
    const r = known - q * 1.570796325802803 - q * 9.920935796805404e-10; // pi/2 in two parts
    const z = r * r;
    const sine = r - r * z * taylor(-z, 3, 2, 17); // C has the signs in the coefficients
    const near = 1 - z / 2;
    const cosine = near + (1 - near - z / 2 + z * z * taylor(-z, 4, 2, 18));
    // & uses an integer of any size modulo 2^32.
    const first = q & 1 ? cosine : sine;
    const second = q & 1 ? sine : cosine;
    return [q & 2 ? -first : first, (q + 1) & 2 ? -second : second];
}
