// SPDX-License-Identifier: MIT
// Test points of the Test Anything Protocol.
import assert from "node:assert/strict";

let count = 0;

export async function test(name, run) {
    count++;
    try {
        await run();
        console.log(`ok ${count} - ${name}`);
    } catch (error) {
        console.log(`not ok ${count} - ${name}\n# ${`${error.stack}`.replaceAll("\n", "\n# ")}`);
    }
}

export function skip(name, reason) {
    console.log(`ok ${++count} - ${name} # SKIP ${reason}`);
}

export const note = (text) => console.log(`# ${text}`);

export const done = () => console.log(`1..${count}`);

/** Checks that `run` throws an error that reads `wanted`; "..." at its end stands for any text. */
export function refused(run, wanted) {
    const [start, open] = wanted.split("...");
    assert.throws(
        run,
        (error) => assert.equal(open === "" ? `${error}`.slice(0, start.length) : `${error}`, start) ?? true,
    );
}
