// SPDX-License-Identifier: MIT
// Tests of the live page. The last line counts them: "N passed, N failed, N skipped".
//
// usage: node run.mjs FOLDER SPRING-SCENE     the output folder of tools/live
import { spawn } from "node:child_process";
import { resolve } from "node:path";
import { fileURLToPath } from "node:url";

import { testHashes } from "./hashes.mjs";
import { testPage } from "./page.mjs";

const [folder, tool] = process.argv.slice(2, 4).map((path) => resolve(path));
const alone = process.argv[4] === "bits"; // a second process, which runs while the browser is tested

function beside() {
    const child = spawn(process.execPath, [fileURLToPath(import.meta.url), folder, tool, "bits"]);
    let said = "";
    child.stdout.on("data", (data) => (said += data));
    child.stderr.pipe(process.stderr);
    return new Promise((done) =>
        child.on("close", () => {
            const lines = said.trimEnd().split("\n");
            const [, passed, failed] = lines.pop().match(/^(\d+) passed, (\d+) failed/) ?? [0, 0, 1];
            console.log(lines.join("\n"));
            done({ passed: Number(passed), failed: Number(failed) });
        }),
    );
}

const suites = alone ? [await testHashes(tool)] : await Promise.all([testPage(folder, tool), beside()]);
const [passed, failed] = ["passed", "failed"].map((key) =>
    suites.reduce((sum, suite) => sum + suite[key], 0),
);
console.log(`${passed} passed, ${failed} failed, 0 skipped`);
process.exit(failed === 0 && passed > 0 ? 0 : 1);
