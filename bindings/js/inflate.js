// SPDX-License-Identifier: MIT
// Bytes from text: base64, and deflate as in RFC 1951. Platforms inflate asynchronously only, and scenes load synchronously.

const lengthOrder = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/** Codes that count up from `first` in groups of `each` with 0, 0, 1, 1, 2 ... extra bits: [base, extra bits] of a symbol. */
function ranges(symbols, first, each, bitsFrom) {
    const list = [];
    for (let i = 0, base = first; i < symbols; i++) {
        const extra = Math.max(0, Math.floor((i - bitsFrom) / each));
        list.push([base, extra]);
        base += 1 << extra;
    }
    return list;
}
const lengths = ranges(28, 3, 4, 4);
lengths.push([258, 0]);
const distances = ranges(30, 1, 2, 2);

/** Canonical Huffman codes: how many there are of each length, and their symbols in order. */
function codesOf(bits) {
    const counts = new Uint16Array(16);
    for (const length of bits) counts[length]++;
    counts[0] = 0;
    const next = new Uint16Array(16);
    for (let i = 1; i < 15; i++) next[i + 1] = next[i] + counts[i];
    const symbols = new Uint16Array(bits.length);
    bits.forEach((length, symbol) => {
        if (length) symbols[next[length]++] = symbol;
    });
    return { counts, symbols };
}

const fixedCodes = [
    codesOf(Array.from({ length: 288 }, (_, i) => (i < 144 || i > 279 ? 8 : i < 256 ? 9 : 7))),
    codesOf(Array(30).fill(5)),
];

/** The bytes of a text. Its first 4 bytes are their number. */
export function inflated(text) {
    const input = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
    const output = new Uint8Array(new DataView(input.buffer).getUint32(0));
    let end = 0;
    let at = 4;
    let held = 0;
    let holds = 0;

    const take = (n) => {
        for (; holds < n; holds += 8) held |= input[at++] << holds;
        const value = held & ((1 << n) - 1);
        held >>>= n;
        holds -= n;
        return value;
    };
    const symbol = ({ counts, symbols }) => {
        let code = 0;
        let first = 0;
        let index = 0;
        for (let length = 1; ; length++) {
            code |= take(1);
            const count = counts[length];
            if (code - count < first) return symbols[index + code - first];
            index += count;
            first = (first + count) << 1;
            code <<= 1;
        }
    };
    const dynamicCodes = () => {
        const literals = take(5) + 257;
        const total = literals + take(5) + 1;
        const given = take(4) + 4;
        const bits = Array(19).fill(0);
        for (let i = 0; i < given; i++) bits[lengthOrder[i]] = take(3);
        const codes = codesOf(bits);
        const all = [];
        while (all.length < total) {
            const code = symbol(codes);
            if (code < 16) all.push(code);
            else {
                const value = code === 16 ? all.at(-1) : 0;
                const times = code === 16 ? 3 + take(2) : code === 17 ? 3 + take(3) : 11 + take(7);
                for (let i = 0; i < times; i++) all.push(value);
            }
        }
        return [codesOf(all.slice(0, literals)), codesOf(all.slice(literals))];
    };

    for (let last = 0; !last;) {
        last = take(1);
        const [literals, offsets] = take(2) === 1 ? fixedCodes : dynamicCodes(); // code has no stored blocks
        for (let code; (code = symbol(literals)) !== 256;) {
            if (code < 256) {
                output[end++] = code;
                continue;
            }
            const [base, extra] = lengths[code - 257];
            const length = base + take(extra);
            const [offset, more] = distances[symbol(offsets)];
            const distance = offset + take(more);
            for (const stop = end + length; end < stop; end++) output[end] = output[end - distance];
        }
    }
    return output;
}
