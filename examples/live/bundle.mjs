// SPDX-License-Identifier: MIT
// Bundles the live page into one file: scripts bundled by esbuild, including their WebAssembly, and styles.
//
// usage: node bundle.mjs FOLDER     writes FOLDER/index.html, which links to FOLDER/../report if that exists
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const [folder] = process.argv.slice(2);
const page = join(dirname(fileURLToPath(import.meta.url)), "page");

// `values`: for each global name of the script, its value as an expression. The values are too long for a command line,
// so the bundle first has placeholders. `more`: further options of esbuild.
function bundled(entry, format, values, ...more) {
    const options = [
        "--bundle",
        "--minify",
        `--format=${format}`,
        "--target=es2022",
        "--legal-comments=none",
        ...more,
    ];
    const placeholders = Object.keys(values).map((name) => `--define:${name}="@${name}@"`);
    const script = execFileSync("esbuild", [join(page, entry), ...options, ...placeholders], {
        encoding: "utf8",
        maxBuffer: 2 ** 26,
    });
    for (const name of Object.keys(values))
        if (!script.includes(`"@${name}@"`)) throw new Error(`${entry}: esbuild left no "@${name}@"`);
    return Object.entries(values).reduce(
        (text, [name, value]) => text.replaceAll(`"@${name}@"`, () => value),
        script,
    );
}

const presets = readFileSync(join(page, "../../../tools/scenes/presets.c"), "utf8");
const worker = bundled("worker.mjs", "iife", { PRESETS: JSON.stringify(presets) });
const reported = existsSync(join(folder, "../report/index.html"));
const script = bundled(
    "main.mjs",
    "esm",
    { WORKER: JSON.stringify(worker) },
    `--define:REPORTED=${reported}`,
);
const styles = [join(page, "../node_modules/uplot/dist/uPlot.min.css"), join(page, "style.css")];
// Escapes text that would end the element or the template. Replaced by functions, since strings would interpret "$&".
const safe = script.replaceAll("</script", "<\\/script");
const html = readFileSync(join(page, "index.html"), "utf8")
    .replace("/*STYLE*/", () => styles.map((name) => readFileSync(name, "utf8")).join("\n"))
    .replace("/*SCRIPT*/", () => safe);
writeFileSync(join(folder, "index.html"), html);
