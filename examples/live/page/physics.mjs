// SPDX-License-Identifier: MIT
// The page's end of the worker: orders go out at once, one tick is under way at a time, questions get a Promise.

export class Physics {
    /** source: of the worker; modules: [with SIMD, without], each a Uint8Array */
    constructor(source, modules) {
        this.worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
        this.worker.onmessage = ({ data }) => this.hear(data);
        this.worker.onerror = (event) => console.error(`physics: ${event.message}`);
        this.waiting = new Map();
        this.asked = 0;
        this.underWay = false;
        this.onmade = this.onframe = () => {};
        this.ready = new Promise((resolve) => (this.isReady = resolve));
        const simd = WebAssembly.validate(modules[0]);
        this.simd = simd;
        this.order("start", { bytes: simd ? modules[0] : modules[1] });
    }

    order(kind, more = {}) {
        this.worker.postMessage({ kind, ...more });
    }

    /** Advances by so many seconds, unless the last tick is still under way: then false. */
    tick(elapsed) {
        if (this.underWay) return false;
        this.underWay = true;
        this.order("tick", { elapsed });
        return true;
    }

    async ask(question, ...parameters) {
        await this.ready;
        const id = this.asked++;
        return new Promise((resolve) => {
            this.waiting.set(id, resolve);
            this.order("ask", { id, question, parameters });
        });
    }

    hear(message) {
        if (message.kind === "ready") this.isReady(message.methods);
        if (message.kind === "made") this.onmade(message);
        if (message.kind === "frame") {
            if (!message.asked) this.underWay = false;
            this.onframe(message);
        }
        if (message.kind === "answer") {
            this.waiting.get(message.id)(message.answer);
            this.waiting.delete(message.id);
        }
    }
}
