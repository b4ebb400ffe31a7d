// SPDX-License-Identifier: MIT
// A minimal test framework: cases run one after the other and are counted.

export class Cases {
    constructor(suite) {
        this.suite = suite;
        this.passed = this.failed = 0;
    }

    async case(name, run) {
        const start = Date.now();
        try {
            await run();
            this.passed++;
            console.log(`ok - ${this.suite}: ${name} (${Date.now() - start} ms)`);
        } catch (error) {
            this.failed++;
            console.log(
                `not ok - ${this.suite}: ${name}\n    ${`${error.stack}`.replaceAll("\n", "\n    ")}`,
            );
        }
    }
}

export async function until(what, holds, seconds = 20) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
        if (await holds()) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`waited ${seconds} s for: ${what}`);
}
