// SPDX-License-Identifier: MIT
// The one instance of the WebAssembly module, which all scenes share, and memory in it. Nothing is compiled before first use.
import { scalar, simd } from "./binary.js";
import { applied, inflated } from "./inflate.js";
import { hasSimd } from "./simd.js";

let calls; // exports of the instance
let forceOf; // what the callback of the scene that is being called does

const imports = { springstep: { force: (...pointers) => forceOf(...pointers) } };

function bytes(withSimd = hasSimd()) {
    const known = inflated(simd);
    return withSimd ? known : applied(inflated(scalar), known);
}

function start(instance) {
    if (calls) return;
    calls = instance.exports;
    calls._initialize?.();
}

/** Compiles in the background. */
export async function ready(options = {}) {
    if (!calls) start((await WebAssembly.instantiate(bytes(options.simd), imports)).instance);
}

/** The functions of the module. */
export function library() {
    if (!calls) start(new WebAssembly.Instance(new WebAssembly.Module(bytes()), imports));
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
