// SPDX-License-Identifier: MIT
// Fills the table of libraries in docs/javascript.md from docs/data/javascript.tsv; with --check, says whether it is filled from it.
//
// usage: node table.mjs [--check]
import { readFileSync, writeFileSync } from "node:fs";

const docs = new URL("../../../docs/", import.meta.url);
const page = new URL("javascript.md", docs);
const data = readFileSync(new URL("data/javascript.tsv", docs), "utf8").trimEnd().split("\n");
const [head, ...rows] = data.filter((line) => !line.startsWith("#")).map((line) => line.split("\t"));

const titles = {
    steady_error_m: "60 Hz",
    hitch_100_ms_error_m: "a frame of 0.1 s",
    hitch_1_s_error_m: "a frame of 1 s",
    retarget_error_m: "new target",
    retarget_bouncy_error_m: "new target, damping 8",
    damping_5000_error_m: "damping 5000",
    time_ns: "ns per value",
};

function shown(column, text) {
    if (text === "nan") return "not finite";
    if (text === "") return "";
    return column === "time_ns" ? `${+Number(text).toPrecision(2)}` : Number(text).toExponential(1);
}

const line = (cells) => `| ${cells.join(" | ")} |`;
const columns = Object.keys(titles);
const place = (name) => {
    const at = head.indexOf(name);
    if (at < 0) throw new Error(`javascript.tsv has no column ${name}`);
    return at;
};
const table = [
    line(["", ...columns.map((column) => titles[column])]),
    line(["---", ...columns.map(() => "---")]).replaceAll(" ", ""),
    ...rows.map((row) => {
        const version = row[place("library")].startsWith("springstep") ? "" : ` ${row[place("version")]}`;
        const cells = columns.map((column) => shown(column, row[place(column)]));
        return line([row[place("library")] + version, ...cells]);
    }),
].join("\n");

const text = readFileSync(page, "utf8");
const filled = text.replace(
    /(<!-- javascript\.tsv -->\n)[^]*?(<!-- end -->)/,
    (_, begin, end) => `${begin}\n${table}\n\n${end}`,
);
if (!filled.includes(table)) throw new Error("docs/javascript.md has no place for the table");
if (process.argv[2] !== "--check") writeFileSync(page, filled);
else if (filled !== text) {
    console.log(
        "docs/javascript.md is not filled from docs/data/javascript.tsv: bindings/js/compare/table.mjs does it",
    );
    process.exitCode = 1;
}
