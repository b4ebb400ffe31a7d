// SPDX-License-Identifier: MIT
// Prints a JavaScript module with two WebAssembly modules in it. The one with SIMD is deflated; the other is mostly copies of
// it, see changes(). Both are in base64.
//
// usage: node embed.mjs SIMD.wasm SCALAR.wasm
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { deflateRawSync } from "node:zlib";
import { applied, inflated } from "../inflate.js";

const shortest = 16; // bytes of a copy

/** The text of `to` as changes of `from`: numbers of new bytes and of copied bytes in turn, where copies start, new bytes. */
function changes(from, to) {
    const known = new Map();
    const key = (bytes, i) => bytes.toString("latin1", i, i + shortest);
    for (let i = from.length - shortest; i >= 0; i--) {
        const list = known.get(key(from, i));
        if (!list) known.set(key(from, i), [i]);
        else if (list.length < 16) list.push(i);
    }
    const sameFrom = (i, j) => {
        let n = 0;
        while (i + n < from.length && j + n < to.length && from[i + n] === to[j + n]) n++;
        return n;
    };
    const numbers = [];
    const fresh = [];
    let last = 0; // the end of the last copy in `from`
    let begun = 0; // new bytes from here on
    for (let j = 0; j < to.length;) {
        const starts = j + shortest <= to.length ? (known.get(key(to, j)) ?? []) : [];
        let best = sameFrom(last, j) >= shortest ? last : -1;
        let length = best < 0 ? shortest - 1 : sameFrom(last, j) + 4; // a start that needs no number is worth a few bytes
        for (const i of starts) if (sameFrom(i, j) > length) [best, length] = [i, sameFrom(i, j)];
        if (best < 0) {
            fresh.push(to[j++]);
            continue;
        }
        length = sameFrom(best, j);
        numbers.push(j - begun, length, best - last);
        last = best + length;
        begun = j += length;
    }
    numbers.push(to.length - begun, 0, 0);
    const bytes = [];
    for (const number of numbers) {
        let rest = number < 0 ? -2 * number - 1 : 2 * number;
        for (; rest > 127; rest = Math.floor(rest / 128)) bytes.push((rest % 128) + 128);
        bytes.push(rest);
    }
    return Buffer.from([...bytes, ...fresh]);
}

const [simd, scalar] = process.argv.slice(2).map((path) => readFileSync(path));
function text(bytes) {
    const size = Buffer.alloc(4);
    size.writeUInt32BE(bytes.length);
    return Buffer.concat([size, deflateRawSync(bytes, { level: 9, memLevel: 9 })]).toString("base64");
}
const simdText = text(simd);
const scalarText = text(changes(simd, scalar));
assert.deepEqual(Buffer.from(inflated(simdText)), simd);
assert.deepEqual(Buffer.from(applied(inflated(scalarText), inflated(simdText))), scalar);
console.log("// SPDX-License-Identifier: MIT");
console.log(
    "// Made by wasm/build: the WebAssembly module with SIMD, and the changes that make the one without SIMD of it.",
);
console.log(`export const simd =\n    "${simdText}";\nexport const scalar =\n    "${scalarText}";`);
