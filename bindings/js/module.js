// SPDX-License-Identifier: MIT
// The one instance of the WebAssembly module, which all scenes share, and memory in it. Nothing is compiled before first use.
import { hasSimd } from "./simd.js";

let calls; // exports of the instance
let forceOf; // what the callback of the scene that is being called does

const imports = { springstep: { force: (...pointers) => forceOf(...pointers) } };

let embedded = null; // the module in hexadecimal digits, which compress better than base64

export const embed = (digits) => (embedded = digits);

const digit = (code) => code - (code < 58 ? 48 : 87);

function inside() {
    if (!hasSimd())
        throw new Error(
            "springstep/scenes needs SIMD for WebAssembly: Chrome 91, Firefox 90, Safari 16.4, Node 18 or later",
        );
    if (embedded === null) throw new Error("springstep/scenes/bare: first await ready() with scenes.wasm");
    const bytes = new Uint8Array(embedded.length / 2);
    for (let i = 0; i < bytes.length; i++)
        bytes[i] = 16 * digit(embedded.charCodeAt(2 * i)) + digit(embedded.charCodeAt(2 * i + 1));
    return bytes;
}

function start(instance) {
    if (calls) return;
    calls = instance.exports;
    calls._initialize?.();
}

/** Compiles in the background: a response with the module, its bytes, or the module; by default the module inside. */
export async function ready(module) {
    if (calls) return;
    let given = (await module) ?? inside();
    if (given.ok === false) throw new Error(`scenes.wasm: ${given.status} ${given.statusText}`);
    if (given.arrayBuffer) given = await given.arrayBuffer();
    const made = await WebAssembly.instantiate(given, imports);
    start(made.instance ?? made);
}

/** The functions of the module. */
export function library() {
    if (!calls) {
        const bytes = inside();
        start(new WebAssembly.Instance(new WebAssembly.Module(bytes), imports));
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
// Functions of the module return pointers above 2 GiB as negative numbers.
const view = (Type) => (pointer, count) => new Type(calls.memory.buffer, pointer >>> 0, count);
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
            const pointer = size < 2 ** 32 ? malloc(Math.max(size, 1)) : 0;
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
