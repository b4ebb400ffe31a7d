// SPDX-License-Identifier: MIT
import type { Module } from "./scenes.js";

export * from "./scenes.js";

/** Compiles the WebAssembly of `springstep/scenes.wasm` in the background. Until then, all other functions throw. */
export declare function ready(module: Module | Promise<Module>): Promise<void>;
