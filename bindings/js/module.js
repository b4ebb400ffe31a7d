// SPDX-License-Identifier: MIT
// The one instance of the WebAssembly module, which all scenes share, and memory in it. Nothing is compiled before first use.
import { binary } from "./binary.js";
import { inflated } from "./inflate.js";

let calls; // exports of the instance
let forceOf; // what the callback of the scene that is being called does

const imports = { springstep: { force: (...pointers) => forceOf(...pointers) } };

// A function that returns a SIMD vector.
const probe = Uint8Array.of(
    ...[0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15],
    ...[253, 98, 11],
);

/** Whether the engine has SIMD for WebAssembly. */
export const hasSimd = () => typeof WebAssembly === "object" && WebAssembly.validate(probe);

const needed =
    "springstep/scenes needs SIMD for WebAssembly: Chrome 91, Firefox 89, Safari 16.4, Node 16.4 or later";
// Without any WebAssembly, as where pages are rendered on a server, only the first use fails.
if (typeof WebAssembly === "object" && !hasSimd()) throw new Error(needed);

function bytes() {
    if (!hasSimd()) throw new Error(needed);
    return inflated(binary);
}

function start(instance) {
    if (calls) return;
    calls = instance.exports;
    calls._initialize?.();
}

/** Compiles in the background. */
export async function ready() {
    if (calls) return;
    const code = bytes();
    start((await WebAssembly.instantiate(code, imports)).instance);
}

/** The functions of the module. */
export function library() {
    if (!calls) {
        const code = bytes();
        start(new WebAssembly.Instance(new WebAssembly.Module(code), imports));
    }
    return calls;
}

/** Runs `call` with another callback. */
export function withForce(callback, call) {
    const before = forceOf;
    forceOf = callback;
    try {
        return call();
    } finally {
        forceOf = before;
    }
}

// Views are made where they are used, because they are lost when memory grows.
const view = (Type) => (pointer, count) => new Type(calls.memory.buffer, pointer, count);
export const memory = {
    float64: view(Float64Array),
    float32: view(Float32Array),
    uint32: view(Uint32Array),
    uint8: view(Uint8Array),
};

export class NoMemory extends RangeError {
    constructor(bytes) {
        super(`no memory for ${bytes} bytes`);
        this.name = "RangeError";
    }
}

/** Runs `use(take)`; take(bytes) returns a pointer that is valid until `use` ends. */
export function borrowed(use) {
    const { malloc, free } = library();
    const taken = [];
    try {
        return use((size) => {
            const pointer = size < 2 ** 32 ? malloc(Math.max(size, 1)) >>> 0 : 0;
            if (pointer === 0) throw new NoMemory(size);
            taken.push(pointer);
            return pointer;
        });
    } finally {
        for (const pointer of taken) free(pointer);
    }
}

/** The text at a pointer. */
export function text(pointer) {
    let string = "";
    for (const byte of new Uint8Array(calls.memory.buffer, pointer)) {
        if (byte === 0) break;
        string += String.fromCharCode(byte);
    }
    return string;
}
