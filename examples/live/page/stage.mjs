// SPDX-License-Identifier: MIT
// One canvas, divided into panes that show the same scene from the same viewpoint. A lost context is restored.
import {
    Color,
    NoToneMapping,
    PerspectiveCamera,
    Plane,
    Raycaster,
    Scene,
    Vector2,
    Vector3,
    WebGLRenderer,
} from "three";

import { Cloth } from "./scenes/cloth.mjs";
import { Curtain } from "./scenes/curtain.mjs";
import { Jelly } from "./scenes/jelly.mjs";
import { Rope } from "./scenes/rope.mjs";
import { Water } from "./scenes/water.mjs";

const samples = 9; // of the time of drawing

const views = { water: Water, cloth: Cloth, rope: Rope, jelly: Jelly, curtain: Curtain };

function themeOf(element) {
    const style = getComputedStyle(element);
    const colour = (name) => {
        const c = new Color(style.getPropertyValue(`--${name}`).trim()).convertLinearToSRGB(); // shaders work in sRGB
        return new Vector3(c.r, c.g, c.b);
    };
    const [skyLow, skyHigh, ground, coping] = ["sky-low", "sky-high", "ground", "coping"].map(colour);
    return { skyLow, skyHigh, ground, coping };
}

// Returns true for software rendering, in which antialiasing costs more than the rest of the picture.
function isSoftware() {
    const gl = document.createElement("canvas").getContext("webgl2");
    const info = gl?.getExtension("WEBGL_debug_renderer_info");
    const name = info ? `${gl.getParameter(info.UNMASKED_RENDERER_WEBGL)}` : "";
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|software/i.test(name);
}

function dispose({ scene, view }) {
    scene.traverse(({ geometry, material }) => {
        geometry?.dispose();
        material?.dispose();
    });
    view.dispose();
}

export class Stage {
    constructor(canvas) {
        this.canvas = canvas;
        this.software = isSoftware();
        const antialias = !this.software;
        this.draws = 0;
        this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias, stencil: true });
        this.renderer.toneMapping = NoToneMapping;
        this.renderer.autoClear = false;
        this.camera = new PerspectiveCamera(38, 1, 0.05, 60);
        this.camera.up.set(0, 0, 1);
        this.turn = { yaw: 0, pitch: 0 };
        this.panes = [];
        this.lost = false;
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault();
            this.lost = true;
            for (const pane of this.panes) pane.stale = true; // its resources in the context are lost
        });
        canvas.addEventListener("webglcontextrestored", () => {
            this.lost = false;
            this.draw();
        });
        new ResizeObserver(() => this.sharpen()).observe(canvas.parentElement);
        this.sharpen();
    }

    /** Creates a view for each pane. */
    build(info, panes) {
        this.sharpen();
        for (const pane of this.panes) if (!pane.stale) dispose(pane);
        const theme = themeOf(this.canvas);
        const View = views[info.run.scene];
        this.scene = info.run.scene;
        this.info = info;
        this.panes = Array.from({ length: panes }, () => {
            const scene = new Scene();
            const view = new View(info, theme, this.renderer, this.software);
            scene.add(view.group);
            return { scene, view, positions: null };
        });
        this.turn = { yaw: 0, pitch: 0 };
    }

    repaint() {
        const theme = themeOf(this.canvas);
        for (const { view } of this.panes) view.paint(theme);
        this.draw();
    }

    /** Starts with all pixels again. */
    sharpen() {
        this.sharpness = 1; // rendered pixels per pixel of the screen
        this.times = [];
        this.resize();
    }

    resize() {
        const { clientWidth, clientHeight } = this.canvas.parentElement;
        this.ratio = devicePixelRatio;
        this.renderer.setPixelRatio(this.sharpness * Math.min(this.ratio, 2));
        this.renderer.setSize(clientWidth, clientHeight, false);
        this.draw();
    }

    /** Records how long drawing took since `start`. If it is slow at the start of a scene, fewer pixels are rendered. */
    pace(start) {
        const slow = 22; // [ms]
        const gl = this.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the end of drawing
        this.times.push(performance.now() - start);
        if (this.times.length < samples) return;
        const median = this.times.sort((a, b) => a - b)[samples >> 1];
        if (median < slow || this.sharpness < 0.6) return;
        this.sharpness *= 0.85;
        this.times = [];
        this.resize();
    }

    /** The box of pane i, in CSS pixels from the left and the top. Panes are side by side, stacked in narrow windows. */
    box(i) {
        const { clientWidth: w, clientHeight: h } = this.canvas;
        const n = Math.max(1, this.panes.length);
        return w > h * 0.9 ? { x: (w / n) * i, y: 0, w: w / n, h } : { x: 0, y: (h / n) * i, w, h: h / n };
    }

    aim(box) {
        const { from, to, fit } = views[this.scene].camera;
        const { yaw, pitch } = this.turn;
        const target = new Vector3(...to);
        const arm = new Vector3(...from).sub(target);
        const flat = Math.hypot(arm.x, arm.y);
        const angle = Math.atan2(arm.y, arm.x) + yaw;
        const high = Math.max(-0.4, Math.min(1.45, Math.atan2(arm.z, flat) + pitch));
        // the scene fits into a box of this shape; for narrower panes the camera is farther away
        const reach = arm.length() * Math.max(1, (fit * box.h) / box.w);
        this.camera.position.set(
            target.x + reach * Math.cos(high) * Math.cos(angle),
            target.y + reach * Math.cos(high) * Math.sin(angle),
            target.z + reach * Math.sin(high),
        );
        this.camera.aspect = box.w / box.h;
        this.camera.lookAt(target);
        this.camera.updateProjectionMatrix();
        this.camera.updateMatrixWorld();
    }

    update(frame) {
        frame.panes.forEach((picture, i) => {
            const pane = this.panes[i];
            if (!pane || picture.positions.length !== 3 * this.info.particles) return;
            if (picture.exploded && pane.positions && !this.tame(picture.positions)) return;
            pane.positions = picture.positions;
            pane.view.update(picture);
        });
    }

    // If particles are out of sight, the last picture is kept.
    tame(positions) {
        const most = 40 * this.info.length;
        return positions.every((x) => Math.abs(x) < most);
    }

    draw() {
        if (this.lost || this.panes.length === 0) return;
        const { renderer } = this;
        const start = performance.now();
        renderer.setScissorTest(true);
        const height = this.canvas.clientHeight;
        this.panes.forEach(({ scene, view }, i) => {
            const box = this.box(i);
            this.aim(box);
            view.look(this.camera);
            renderer.setViewport(box.x, height - box.y - box.h, box.w, box.h);
            renderer.setScissor(box.x, height - box.y - box.h, box.w, box.h);
            renderer.clear();
            renderer.render(scene, this.camera);
        });
        if (++this.draws % 10 === 0 && this.times.length < samples) this.pace(start); // rarely, because it waits
    }

    // --- what is under a point of the canvas ------------------------------------------------------------------------

    /** {pane, ray} at CSS pixels. */
    rayAt(x, y) {
        let pane = this.panes.findIndex((_, i) => {
            const box = this.box(i);
            return x >= box.x && x < box.x + box.w && y >= box.y && y < box.y + box.h;
        });
        pane = Math.max(0, pane);
        return { pane, ray: this.rayIn(pane, x, y) };
    }

    rayIn(pane, x, y) {
        const box = this.box(pane);
        this.aim(box);
        const caster = new Raycaster();
        caster.setFromCamera(
            new Vector2((2 * (x - box.x)) / box.w - 1, 1 - (2 * (y - box.y)) / box.h),
            this.camera,
        );
        return caster.ray;
    }

    /** The intersection of the ray with the water at rest, [x, y] of the scene, or null. */
    onWater(ray) {
        const hit = ray.intersectPlane(new Plane(new Vector3(0, 0, 1), 0), new Vector3());
        if (!hit) return null;
        const { length } = this.info;
        const [x, y] = [hit.x + length / 2, hit.y + length / 2];
        return x >= 0 && x <= length && y >= 0 && y <= length ? [x, y] : null;
    }

    /** The intersection of the ray with the plane of a curtain, [x, z] of the scene, or null outside of it. */
    onCurtain(pane, ray) {
        const hit = ray.intersectPlane(new Plane(new Vector3(0, 1, 0), 0), new Vector3());
        if (!hit) return null;
        const [x, , z] = this.toScene(pane, hit);
        const { length } = this.info;
        return x > -0.1 && x < length + 0.1 && z > -length - 0.1 && z < 0.1 ? [x, z] : null;
    }

    /** The particle nearest to the ray within a number of CSS pixels; of equally near particles, the one in front. */
    nearest(pane, ray, pixels) {
        const { positions, view } = this.panes[pane];
        if (!positions) return null;
        const offset = view.group.position;
        const box = this.box(pane);
        const scale = box.h / 2 / Math.tan((this.camera.fov * Math.PI) / 360);
        const p = new Vector3();
        const rel = new Vector3();
        let best = null;
        let least = Infinity;
        for (let i = 0; i < this.info.particles; i++) {
            p.fromArray(positions, 3 * i).add(offset);
            const along = rel.copy(p).sub(ray.origin).dot(ray.direction);
            if (along <= 0) continue;
            const away = (Math.sqrt(ray.distanceSqToPoint(p)) / along) * scale;
            if (away > pixels) continue;
            const score = away + (20 * along) / this.info.length;
            if (score < least) {
                least = score;
                best = i;
            }
        }
        return best;
    }

    /** A plane through a particle, facing the camera. */
    planeThrough(pane, particle) {
        const { positions, view } = this.panes[pane];
        const p = new Vector3().fromArray(positions, 3 * particle).add(view.group.position);
        this.aim(this.box(pane));
        const normal =
            this.scene === "rope" ? new Vector3(0, 1, 0) : this.camera.getWorldDirection(new Vector3());
        return new Plane().setFromNormalAndCoplanarPoint(normal, p);
    }

    /** The position of a particle of a pane in CSS pixels. */
    pixelOf(pane, particle) {
        const { positions, view } = this.panes[pane];
        const box = this.box(pane);
        this.aim(box);
        const p = new Vector3()
            .fromArray(positions, 3 * particle)
            .add(view.group.position)
            .project(this.camera);
        return [box.x + ((p.x + 1) / 2) * box.w, box.y + ((1 - p.y) / 2) * box.h];
    }

    toScene(pane, point) {
        return point.clone().sub(this.panes[pane].view.group.position).toArray();
    }
}
