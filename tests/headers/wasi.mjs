/* SPDX-License-Identifier: MIT */
/* Runs a WebAssembly program under Node.js: node wasi.mjs PROGRAM */
import { readFileSync } from 'node:fs';
import { WASI } from 'node:wasi';

const wasi = new WASI({ version: 'preview1' });
const program = await WebAssembly.compile(readFileSync(process.argv[2]));
wasi.start(await WebAssembly.instantiate(program, wasi.getImportObject()));
