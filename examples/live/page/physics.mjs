// SPDX-License-Identifier: MIT
// The interface of the page to the worker. Commands are sent when the worker is ready, one tick is pending at a time,
// and questions return a Promise. Of scenes ordered in quick succession, only the last is shown. After an exception in
// the worker, nothing is sent until start().

export class Physics {
    /** source: source text of the worker */
    constructor(source) {
        this.source = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
        this.asked = 0;
        this.works = false; // the browser can run the library
        this.onmade = this.onframe = this.onfailed = () => {};
        this.start();
    }

    /** Starts a new worker without a scene. */
    start() {
        this.worker?.terminate();
        this.worker = new Worker(this.source);
        this.worker.onmessage = ({ data }) => this.hear(data);
        this.worker.onerror = ({ message }) => this.fail(message);
        this.waiting = new Map();
        this.underWay = this.failed = false;
        this.making = 0; // scenes ordered, but not made
        this.ready = new Promise((resolve) => (this.isReady = resolve));
        this.worker.postMessage({ kind: "start" });
    }

    fail(message) {
        this.failed = true;
        for (const { reject } of this.waiting.values()) reject(new Error(message));
        this.waiting.clear();
        this.onfailed(message);
    }

    order(kind, more = {}) {
        const { worker } = this;
        if (kind === "make") this.making++;
        this.ready.then(() => worker.postMessage({ kind, ...more }));
    }

    /** Calls a function of every lab. */
    touch(call, ...values) {
        this.order("touch", { call, values });
    }

    /** Advances by a time [s]. Returns false if the last tick is still pending. */
    tick(elapsed) {
        if (this.underWay || this.failed) return false;
        this.underWay = true;
        this.order("tick", { elapsed });
        return true;
    }

    ask(question, ...parameters) {
        if (this.failed) return Promise.reject(new Error("the physics has stopped"));
        const id = this.asked++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve, reject });
            this.order("ask", { id, question, parameters });
        });
    }

    hear(message) {
        if (message.kind === "ready") {
            this.works = true;
            this.isReady();
        }
        if (message.kind === "made" && --this.making === 0) this.onmade(message);
        if (message.kind === "frame") {
            if (!message.asked) this.underWay = false;
            if (this.making === 0) this.onframe(message);
        }
        if (message.kind === "answer") {
            this.waiting.get(message.id)?.resolve(message.answer);
            this.waiting.delete(message.id);
        }
    }
}
