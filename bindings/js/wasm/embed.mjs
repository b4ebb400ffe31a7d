// SPDX-License-Identifier: MIT
// Prints a JavaScript module with a WebAssembly module in it: deflated, in base64.
//
// usage: node embed.mjs MODULE.wasm
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { deflateRawSync } from "node:zlib";
import { inflated } from "../inflate.js";

const bytes = readFileSync(process.argv[2]);
const size = Buffer.alloc(4);
size.writeUInt32BE(bytes.length);
const text = Buffer.concat([size, deflateRawSync(bytes, { level: 9, memLevel: 9 })]).toString("base64");
assert.deepEqual(Buffer.from(inflated(text)), bytes);
console.log(`// SPDX-License-Identifier: MIT
// Made by wasm/build: the WebAssembly module.
export const binary =
    "${text}";`);
