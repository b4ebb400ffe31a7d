// SPDX-License-Identifier: MIT
// The package in Chromium, as ES modules: on the page without waiting, in a worker, after ready(), and 200 scenes.
//     node browser.mjs PROJECT     in whose node_modules it is installed
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";
import { done, skip, test } from "./tap.mjs";

const project = process.argv[2];
const chromium = process.env.CHROMIUM ?? "/usr/bin/chromium";
const program = `
    export function falls({ grid, Scene }, { Spring }) {
        const sheet = grid({ count: [25, 25], spacing: 0.1, stiffness: 400, damping: 0.01, pinned: ["firstY"] });
        const scene = new Scene({ ...sheet, mass: 0.01, gravity: [0, -9.81, 0] });
        scene.advance("leapfrog", 1 / 1200, 300);
        const sum = scene.get("position").reduce((all, x) => all + x, 0);
        scene.free();
        const spring = new Spring(0, { hertz: 2, dampingRatio: 0.3 });
        spring.target = 1;
        for (let i = 0; i < 20; i++) spring.step(1 / 60);
        return [sum, spring.value].join();
    }`;
const worker = `
    import { falls } from "/program.js";
    import * as scenes from "/node_modules/springstep/scenes.js";
    import * as springs from "/node_modules/springstep/index.js";
    postMessage(falls(scenes, springs));`;
const page = (how) => `<!doctype html><title>waiting</title>
    <script type="importmap">{"imports": {
        "springstep": "/node_modules/springstep/index.js",
        "springstep/scenes": "/node_modules/springstep/scenes.js"}}</script>
    <script type="module">
        import * as scenes from "springstep/scenes";
        import * as springs from "springstep";
        import { falls } from "/program.js";
        const answer = (text) => (document.title = "answer " + text);
        try { ${how} } catch (error) { answer(error.stack); }
    </script>`;
const pages = {
    "/once": page("answer(falls(scenes, springs))"),
    "/ready": page("await scenes.ready(); answer(falls(scenes, springs))"),
    "/many": page(`let all = new Set();
        for (let i = 0; i < 200; i++) all.add(falls(scenes, springs));
        answer([...all].join())`),
    "/worker": page(`const worker = new Worker("/worker.js", { type: "module" });
        worker.onmessage = ({ data }) => answer(data);
        worker.onerror = ({ message }) => answer(message);`),
};
const scripts = { "/program.js": program, "/worker.js": worker };

const server = createServer(async ({ url }, response) => {
    try {
        if (pages[url]) return response.setHeader("content-type", "text/html").end(pages[url]);
        const file = join(project, normalize(url));
        const text = scripts[url] ?? (await readFile(file));
        response
            .setHeader("content-type", extname(url) === ".js" ? "text/javascript" : "text/plain")
            .end(text);
    } catch {
        response.writeHead(404).end();
    }
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const { port } = server.address();

const flags = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-background-networking",
];
flags.push("--virtual-time-budget=60000", "--dump-dom");
const titleOf = (path) =>
    new Promise((resolve, reject) =>
        execFile(
            chromium,
            [...flags, `http://127.0.0.1:${port}${path}`],
            { timeout: 60000, maxBuffer: 1 << 26 },
            (error, out) => {
                if (error) reject(error);
                else resolve(out.match(/<title>([^]*?)<\/title>/)?.[1]);
            },
        ),
    );

const exists = await readFile(chromium).then(
    () => true,
    () => false,
);
if (!exists) skip("the package in Chromium", `no ${chromium}`);
else {
    const folder = join(project, "node_modules/springstep");
    const load = (name) => import(pathToFileURL(join(folder, name)));
    const { falls } = await import(`data:text/javascript,${encodeURIComponent(program)}`);
    const wanted = falls(await load("scenes.js"), await load("index.js"));
    for (const path of Object.keys(pages))
        await test(`Chromium has the bits of Node: ${path.slice(1)}`, async () =>
            assert.equal(await titleOf(path), `answer ${wanted}`));
}
server.close();
done();
