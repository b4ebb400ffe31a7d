// SPDX-License-Identifier: MIT
// Water in a tiled pool. The surface reflects a sky and refracts the pool: every fragment follows one ray to the floor
// or a wall, computes the colour of its tiles by a formula, and looks up the caustics of the waves there.
import {
    BufferAttribute,
    BufferGeometry,
    DataTexture,
    FloatType,
    LinearFilter,
    Group,
    Mesh,
    NearestFilter,
    Path,
    PlaneGeometry,
    RGBAFormat,
    ShaderMaterial,
    Shape,
    ShapeGeometry,
    SphereGeometry,
    Vector3,
    Vector4,
} from "three";

import { Upsampler } from "../surface.mjs";

const depth = 1.15; // [m]
const rim = 0.05; // [m] height of the pool above the water
const exaggeration = 2; // of heights

const shared = /* glsl */ `
    uniform float side;
    uniform vec3 sun, skyLow, skyHigh;
    uniform sampler2D waves;
    uniform vec4 ball;

    vec3 sky(vec3 d) {
        float up = clamp(d.z, 0.0, 1.0);
        float s = dot(d, sun) - 1.0;
        return mix(skyLow, skyHigh, sqrt(up)) + vec3(1.0, 0.9, 0.75) * (0.25 * exp2(34.0 * s) + 4.0 * exp2(1300.0 * s));
    }

    vec3 tiles(vec2 p) {
        vec2 cell = fract(p * 4.0), edge = min(cell, 1.0 - cell);
        float joint = smoothstep(0.02, 0.06, min(edge.x, edge.y));
        vec2 which = floor(p * 4.0);
        float tone = fract(52.98 * fract(dot(which, vec2(0.6711, 0.2584))));
        return mix(vec3(0.36, 0.52, 0.56), mix(vec3(0.50, 0.78, 0.82), vec3(0.66, 0.89, 0.90), tone), joint);
    }

    // what lies at a point of the floor or a wall, in the light that the surface lets through
    vec3 pool(vec3 p) {
        vec3 c;
        float light;
        if (p.z < -${depth.toFixed(2)} + 0.004) {
            c = tiles(p.xy);
            vec2 from = (p.xy + sun.xy / sun.z * 0.55) / side;
            float gather = texture2D(waves, from).a;
            light = 0.62 + 0.42 * clamp(1.0 + gather, 0.15, 3.2);
            vec2 wall = min(p.xy, side - p.xy);
            light *= 0.62 + 0.38 * smoothstep(0.0, 0.5, min(wall.x, wall.y));
            if (ball.w > 0.0) {
                float away = length(p.xy - ball.xy + sun.xy / sun.z * (ball.z - p.z));
                light *= mix(0.5, 1.0, smoothstep(0.6 * ball.w, 1.25 * ball.w, away));
            }
        } else {
            bool x = p.x < 0.004 || p.x > side - 0.004;
            c = tiles(x ? p.yz : p.xz);
            light = 0.62 + 0.26 * smoothstep(-${depth.toFixed(2)}, 0.0, p.z);
        }
        return c * light;
    }`;

const ballColour = /* glsl */ `
    vec3 beach(vec3 n) {
        float around = atan(n.y, n.x) / 6.2831853 + 0.5, stripe = floor(around * 6.0);
        vec3 c = mod(stripe, 2.0) < 0.5 ? vec3(0.93, 0.30, 0.22) : vec3(0.97, 0.95, 0.90);
        if (n.z > 0.93) c = vec3(0.97, 0.80, 0.25);
        return c * (0.45 + 0.65 * max(dot(n, sun), 0.0) + 0.12 * n.z);
    }`;

const surfaceVertex = /* glsl */ `
    uniform sampler2D waves;
    uniform float side;
    varying vec3 place, normalOf;
    void main() {
        vec4 w = texture2D(waves, uv);
        place = vec3(uv * side, w.r);
        normalOf = vec3(-w.gb, 1.0);
        gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
    }`;

const surfaceFragment = /* glsl */ `
    ${shared}
    ${ballColour}
    uniform vec3 eye;
    varying vec3 place, normalOf;
    void main() {
        vec3 n = normalize(normalOf), d = normalize(place - eye);
        float facing = clamp(-dot(n, d), 0.0, 1.0);
        float glance = 1.0 - facing, glance2 = glance * glance;
        float mirror = 0.02 + 0.98 * glance2 * glance2 * glance;
        vec3 above = sky(reflect(d, n));

        vec3 t = refract(d, n, 0.75);
        vec3 far = (step(0.0, t) * vec3(side, side, 0.0) - place) / t; // to each wall
        float down = (-${depth.toFixed(2)} - place.z) / min(t.z, -1e-3);
        float path = min(min(far.x, far.y), down);
        vec3 seen = pool(place + path * t);
        if (ball.w > 0.0) {
            vec3 o = place - ball.xyz;
            float b = dot(o, t), q = b * b - dot(o, o) + ball.w * ball.w;
            if (q > 0.0 && -b - sqrt(q) > 0.0 && -b - sqrt(q) < path) {
                path = -b - sqrt(q);
                seen = 0.85 * beach((o + path * t) / ball.w);
            }
        }
        vec3 below = mix(vec3(0.05, 0.36, 0.46), seen, exp2(-path * vec3(0.70, 0.20, 0.15)));
        gl_FragColor = vec4(1.06 * mix(below, above, mirror), 1.0);
    }`;

const wallFragment = /* glsl */ `
    ${shared}
    varying vec3 place;
    void main() { gl_FragColor = vec4(pool(place) * 1.05, 1.0); }`;

const plainVertex = /* glsl */ `
    varying vec3 place;
    void main() { place = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;

const ballFragment = /* glsl */ `
    ${shared}
    ${ballColour}
    uniform vec3 eye;
    varying vec3 place;
    void main() {
        vec3 n = normalize(place), d = normalize(ball.xyz + ball.w * n - eye);
        float mirror = 0.04 + 0.5 * pow(1.0 - clamp(-dot(n, d), 0.0, 1.0), 5.0);
        gl_FragColor = vec4(mix(beach(n), sky(reflect(d, n)), mirror), 1.0);
    }`;

const groundFragment = /* glsl */ `
    uniform vec3 ground, coping;
    uniform float side;
    varying vec3 place;
    void main() {
        vec2 out2 = max(max(-place.xy, place.xy - side), 0.0);
        float away = length(out2), stone = 1.0 - smoothstep(0.29, 0.30, max(out2.x, out2.y));
        vec2 along = fract(place.xy * 1.25);
        float joint = min(min(along.x, 1.0 - along.x), min(along.y, 1.0 - along.y));
        vec3 c = mix(ground, coping * (0.90 + 0.10 * smoothstep(0.0, 0.02, joint)), stone);
        c *= 0.80 + 0.20 * smoothstep(0.0, 0.10, away);
        gl_FragColor = vec4(c, 1.0 - smoothstep(1.2, 3.0, away));
    }`;

function walls(side) {
    const corners = [
        [0, 0],
        [side, 0],
        [side, side],
        [0, side],
    ];
    const points = corners.flatMap((a, i) => {
        const b = corners[(i + 1) % 4];
        return [...a, -0.4, ...b, -0.4, ...b, rim, ...a, -0.4, ...b, rim, ...a, rim];
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
    return geometry;
}

function groundAround(side) {
    const outside = side + 3.2;
    const shape = new Shape();
    shape.moveTo(-3.2, -3.2).lineTo(outside, -3.2).lineTo(outside, outside).lineTo(-3.2, outside);
    shape.holes.push(new Path().moveTo(0, 0).lineTo(0, side).lineTo(side, side).lineTo(side, 0));
    return new ShapeGeometry(shape).translate(0, 0, rim);
}

export class Water {
    static camera = { from: [0.55, -4.75, 2.95], to: [0.02, -0.25, -0.3], fit: 1.4 };

    constructor(info, theme, renderer, software) {
        const n = info.count[0];
        const side = info.length;
        const times = Math.max(1, Math.round((software ? 48 : 96) / (n - 1)));
        this.n = n;
        this.upsampler = new Upsampler(n, times);
        const fine = this.upsampler.fine;
        this.heights = new Float32Array(fine * fine);
        this.texels = new Float32Array(4 * fine * fine);
        this.texture = new DataTexture(this.texels, fine, fine, RGBAFormat, FloatType);
        const smooth = renderer.extensions.has("OES_texture_float_linear");
        this.texture.minFilter = this.texture.magFilter = smooth ? LinearFilter : NearestFilter;
        this.uniforms = {
            side: { value: side },
            waves: { value: this.texture },
            sun: { value: new Vector3(0.35, 0.65, 0.68).normalize() },
            eye: { value: new Vector3() },
            ball: { value: new Vector4() },
            skyLow: { value: null },
            skyHigh: { value: null },
            ground: { value: null },
            coping: { value: null },
        };
        this.side = side;
        this.group = new Group();
        this.group.position.set(-side / 2, -side / 2, 0);
        const { uniforms } = this;
        const add = (geometry, vertexShader, fragmentShader, more = {}) => {
            const material = new ShaderMaterial({ vertexShader, fragmentShader, uniforms, ...more });
            const mesh = new Mesh(geometry, material);
            mesh.frustumCulled = false;
            this.group.add(mesh);
            return mesh;
        };
        add(new PlaneGeometry(1, 1, fine - 1, fine - 1), surfaceVertex, surfaceFragment);
        add(walls(side), plainVertex, wallFragment);
        add(groundAround(side), plainVertex, groundFragment, { transparent: true });
        this.ball = add(new SphereGeometry(1, 40, 24), plainVertex, ballFragment);
        this.paint(theme);
    }

    paint(theme) {
        for (const name of ["skyLow", "skyHigh", "ground", "coping"]) this.uniforms[name].value = theme[name];
    }

    update({ positions, ball }) {
        const { n, upsampler, heights, texels, side } = this;
        const { fine } = upsampler;
        upsampler.run(
            (i, j) => exaggeration * Math.max(-0.6, Math.min(0.6, positions[3 * (i + n * j) + 2])),
            heights,
        );
        const across = (fine - 1) / side / 2;
        const gather = 0.03 * (2 * across) ** 2;
        for (let j = 0, at = 0; j < fine; j++)
            for (let i = 0; i < fine; i++, at++) {
                const left = i > 0 ? heights[at - 1] : heights[at];
                const right = i < fine - 1 ? heights[at + 1] : heights[at];
                const near = j > 0 ? heights[at - fine] : heights[at];
                const away = j < fine - 1 ? heights[at + fine] : heights[at];
                texels[4 * at] = heights[at];
                texels[4 * at + 1] = (right - left) * across;
                texels[4 * at + 2] = (away - near) * across;
                texels[4 * at + 3] = (4 * heights[at] - left - right - near - away) * gather;
            }
        this.texture.needsUpdate = true;
        this.ball.visible = ball !== null;
        if (ball) {
            const [x, y, z, radius] = ball;
            this.uniforms.ball.value.set(x, y, z, radius);
            this.ball.position.set(x, y, z);
            this.ball.scale.setScalar(radius);
        } else this.uniforms.ball.value.w = 0;
    }

    look(camera) {
        this.uniforms.eye.value.copy(camera.position).sub(this.group.position);
    }

    dispose() {
        this.texture.dispose();
    }
}
