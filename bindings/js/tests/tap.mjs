// SPDX-License-Identifier: MIT
// Test points of the Test Anything Protocol.

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
