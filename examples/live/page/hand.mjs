// SPDX-License-Identifier: MIT
// Pointer, touch and keyboard input: poke water, grab a particle, cut, or turn the view. The keyboard moves a cursor
// that acts like a finger.
import { Vector3 } from "three";

const pokeEvery = 70; // [ms] while a pointer moves over the water
const reach = 56; // [CSS px] largest distance for grabbing a particle

export class Hand {
    /** act: {poke(x, y), push(x, z), letGo(), grab(particle), drag([x, y, z]), release(), snip(particle)};
        scissors(): true if cutting is chosen */
    constructor(stage, cursor, act, scissors) {
        Object.assign(this, { stage, cursor, act, scissors });
        this.stop();
        this.place = null; // of the keyboard's cursor [CSS px]
        const { canvas } = stage;
        canvas.addEventListener("pointerdown", (event) => this.down(event));
        canvas.addEventListener("pointermove", (event) =>
            this.move(event.offsetX, event.offsetY, event.pointerId),
        );
        for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
            canvas.addEventListener(end, (event) => this.up(event.pointerId));
        canvas.addEventListener("keydown", (event) => this.key(event));
        canvas.addEventListener("blur", () => {
            this.cursor.hidden = true;
            this.up("keyboard");
        });
    }

    /** Ignores input until begun(), because the scene on the screen is no longer the scene of the physics. */
    stop() {
        this.doing = null;
        this.stopped = true;
    }

    /** Resets the state for a new scene: nothing is held, and the cursor has no position. */
    begun() {
        this.stopped = false;
        this.place = null;
        this.cursor.hidden = true;
    }

    down(event) {
        if (this.stopped || this.doing || event.button > 0) return;
        this.cursor.hidden = true;
        try {
            this.stage.canvas.setPointerCapture(event.pointerId);
        } catch {
            // the pointer has already gone, or is not a real one
        }
        this.begin(event.offsetX, event.offsetY, event.pointerId);
    }

    begin(x, y, by) {
        const { stage, act } = this;
        const { pane, ray } = stage.rayAt(x, y);
        this.doing = { kind: "turn", pane, by, x, y };
        if (stage.scene === "water") {
            const at = stage.onWater(ray);
            if (!at) return;
            act.poke(...at);
            Object.assign(this.doing, { kind: "poke", last: performance.now() });
            return;
        }
        if (stage.scene === "curtain") {
            const at = stage.onCurtain(pane, ray);
            if (!at) return;
            act.push(...at);
            this.doing.kind = "push";
            return;
        }
        const particle = stage.nearest(pane, ray, reach);
        if (this.scissors()) {
            this.doing.kind = "cut";
            if (particle !== null) act.snip(particle);
        } else if (particle !== null) {
            Object.assign(this.doing, { kind: "hold", particle, plane: stage.planeThrough(pane, particle) });
            act.grab(particle);
        }
    }

    move(x, y, by) {
        const { doing, stage, act } = this;
        if (!doing || doing.by !== by) return;
        const ray = stage.rayIn(doing.pane, x, y);
        if (doing.kind === "turn") {
            stage.turn.yaw -= (x - doing.x) * 0.006;
            stage.turn.pitch += (y - doing.y) * 0.005;
            Object.assign(doing, { x, y });
            stage.draw();
        } else if (doing.kind === "poke") {
            const at = stage.onWater(ray);
            if (at && performance.now() - doing.last > pokeEvery) {
                act.poke(...at);
                doing.last = performance.now();
            }
        } else if (doing.kind === "push") {
            const at = stage.onCurtain(doing.pane, ray);
            if (at) act.push(...at);
        } else if (doing.kind === "cut") {
            const particle = stage.nearest(doing.pane, ray, reach / 3);
            if (particle !== null) act.snip(particle);
        } else {
            const point = ray.intersectPlane(doing.plane, new Vector3());
            if (point) act.drag(stage.toScene(doing.pane, point));
        }
    }

    up(by) {
        if (!this.doing || this.doing.by !== by) return;
        if (this.doing.kind === "hold") this.act.release();
        if (this.doing.kind === "push") this.act.letGo();
        this.doing = null;
    }

    key(event) {
        const shortcut = event.altKey || event.ctrlKey || event.metaKey; // of the browser
        if (this.stopped || shortcut) return;
        const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
        const arrow = arrows[event.key];
        if (!arrow && event.key !== "Enter" && event.key !== "Escape") return;
        event.preventDefault();
        const { clientWidth, clientHeight } = this.stage.canvas;
        if (this.cursor.hidden || !this.place) {
            this.place ??= this.stage.panes.length ? this.startPlace() : [clientWidth / 2, clientHeight / 2];
            this.cursor.hidden = false;
        }
        if (arrow) {
            const pace = event.shiftKey ? 4 : 18;
            this.place[0] = Math.min(clientWidth - 1, Math.max(0, this.place[0] + pace * arrow[0]));
            this.place[1] = Math.min(clientHeight - 1, Math.max(0, this.place[1] + pace * arrow[1]));
            this.move(...this.place, "keyboard");
        } else if (event.key === "Enter" && !this.doing) {
            this.begin(...this.place, "keyboard");
            if (this.doing.kind !== "hold" && this.doing.kind !== "push") this.doing = null;
        } else this.up("keyboard");
        this.cursor.classList.toggle("holds", this.doing?.by === "keyboard");
        this.cursor.style.left = `${this.place[0]}px`;
        this.cursor.style.top = `${this.place[1]}px`;
    }

    // Starts in the middle of the first pane for water, otherwise on a particle.
    startPlace() {
        const { stage } = this;
        const box = stage.box(0);
        if (stage.scene === "water" || !stage.panes[0].positions)
            return [box.x + box.w / 2, box.y + box.h / 2];
        return stage.pixelOf(0, stage.info.particles - 1);
    }
}
