// SPDX-License-Identifier: MIT
// Puts the live page into one file: scripts bundled by esbuild, styles, and both WebAssembly modules.
//
// usage: node bundle.mjs FOLDER     with lab.wasm and lab-nosimd.wasm; writes FOLDER/index.html
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const [folder] = process.argv.slice(2);
const page = join(dirname(fileURLToPath(import.meta.url)), "page");

async function bundled(entry, define = {}) {
    const result = await build({
        entryPoints: [join(page, entry)],
        bundle: true,
        minify: true,
        write: false,
        format: entry === "worker.mjs" ? "iife" : "esm",
        target: "es2022",
        legalComments: "none",
        define,
    });
    return result.outputFiles[0].text;
}

const base64 = (name) => JSON.stringify(readFileSync(join(folder, name)).toString("base64"));
const script = await bundled("main.mjs", {
    WORKER: JSON.stringify(await bundled("worker.mjs")),
    MODULE: base64("lab.wasm"),
    MODULE_WITHOUT_SIMD: base64("lab-nosimd.wasm"),
});
const styles = [join(page, "../node_modules/uplot/dist/uPlot.min.css"), join(page, "style.css")];
// What would end the element or the template is written otherwise; a function, for a string would read "$&".
const safe = script.replaceAll("</script", "<\\/script");
const html = readFileSync(join(page, "index.html"), "utf8")
    .replace("/*STYLE*/", () => styles.map((name) => readFileSync(name, "utf8")).join("\n"))
    .replace("/*SCRIPT*/", () => safe);
writeFileSync(join(folder, "index.html"), html);
