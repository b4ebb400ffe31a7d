// SPDX-License-Identifier: MIT
// Runs a program for WASI. With a list of functions: checks that a module exports them and imports nothing.
//     node wasi.mjs MODULE [LIST]
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [module, list] = process.argv.slice(2);
const compiled = await WebAssembly.compile(readFileSync(module));
if (list) {
    const wanted = readFileSync(list, "utf8").trim().split("\n");
    const exported = WebAssembly.Module.exports(compiled).map((each) => each.name);
    const missing = wanted.filter((name) => !exported.includes(name));
    const foreign = exported.filter((name) => name.startsWith("spring_") && !wanted.includes(name));
    const imports = WebAssembly.Module.imports(compiled);
    console.log({ missing, foreign, imports });
    process.exit(missing.length + foreign.length + imports.length > 0 ? 1 : 0);
}
const wasi = new WASI({ version: "preview1", args: ["program"] });
wasi.start(await WebAssembly.instantiate(compiled, wasi.getImportObject()));
