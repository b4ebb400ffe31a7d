// SPDX-License-Identifier: MIT
/// <reference lib="esnext.disposable" />

/** The WebAssembly of scenes: a response of fetch(), bytes, or a compiled module. */
export type Module = Response | BufferSource | WebAssembly.Module;

/**
 * Compiles the WebAssembly in the background: that inside the package, or `springstep/scenes.wasm`. Without it, the first use
 * compiles and waits.
 */
export declare function ready(module?: Module | Promise<Module>): Promise<void>;

/** Whether the engine has SIMD for WebAssembly, which scenes require. Compiles nothing. */
export declare function hasSimd(): boolean;

export type Method = "euler" | "symplectic-euler" | "leapfrog" | "rk4" | "rkn8" | "srkn6";

/** The methods for scenes. `forcesPerStep` is the number of force evaluations where forces do not depend on velocities. */
export declare function methods(): { name: Method; order: number; forcesPerStep: number }[];

export type Quantity = "position" | "velocity" | "force";

/** A spring between particles a and b. */
export interface Link {
    a: number;
    b: number;
    /** [m] rest length >= 0 */
    rest: number;
    /** [N/m] >= 0 */
    stiffness: number;
    /** [N s/m] >= 0, along the link; default 0 */
    damping?: number;
    /** TENSION_ONLY or TETHER; default 0. setLinks() does not change it. */
    flags?: number;
}

/** Flag of a link that pulls and never pushes, with two or three axes. */
export declare const TENSION_ONLY: 1;
/** Flag of a tension-only link that acts only while exactly one of its ends is pinned. */
export declare const TETHER: 2;

/** Springs between two weighted points: their vector is the sum of weight times position over up to four particles. */
export interface WeightedLinks {
    /** four particles of each link in turn */
    particles: ArrayLike<number>;
    /** their weights, whose sum is 0; 0: unused. [-1, a, b, c] attaches a particle to a point in a triangle */
    weights: ArrayLike<number>;
    /** [m] default 0: linear, and damped in all directions */
    rest?: number | ArrayLike<number>;
    /** [N/m] */
    stiffness: number | ArrayLike<number>;
    /** [N s/m] default 0 */
    damping?: number | ArrayLike<number>;
}

/** Weighted links as bendRod() and similar functions return them. */
export interface WeightedLinkArrays {
    particles: Uint32Array;
    weights: Float64Array;
    rest: Float64Array;
    stiffness: Float64Array;
    damping: Float64Array;
}

/** All links as arrays. A number applies to every link. */
export interface Links {
    /** a and b of each link in turn */
    ends: ArrayLike<number>;
    rest: number | ArrayLike<number>;
    stiffness: number | ArrayLike<number>;
    /** default 0 */
    damping?: number | ArrayLike<number>;
    /** default 0 */
    flags?: number | ArrayLike<number>;
}

/** Links as arrays, as getLinks() returns them. */
export interface LinkArrays {
    ends: Uint32Array;
    rest: Float64Array;
    stiffness: Float64Array;
    damping: Float64Array;
    flags: Uint32Array;
}

/**
 * Adds forces to force[axis][particle] [N] at the time t [s]. It must depend only on its arguments and on data that has not
 * changed since `scene.force` was set. It must not call its own scene. It should not create scenes or grids, or copy arrays of
 * other scenes: if the memory of the WebAssembly grows meanwhile, the arrays are lost. If that happens, if it throws, or if it is
 * async, the call fails and the scene stays as it was (unless it has `noUndo`). advance() of a scene whose particles are all
 * pinned also fails then, but completes its steps first.
 */
export type Force = (
    t: number,
    position: readonly Float64Array[],
    force: readonly Float64Array[],
    velocity: readonly Float64Array[] | undefined,
) => void;

/**
 * What every collider has. Vectors have three numbers, or one for each axis of the scene. `spin` and `spinAcceleration` always
 * have three.
 */
export interface Body {
    /** [m] a point of the plane; the centre; or one end of a capsule; default [0, 0, 0] */
    at?: ArrayLike<number>;
    /** [m/s] */
    velocity?: ArrayLike<number>;
    /** [rad/s] turns planes and boxes about `at`; of spheres and capsules the surface. With two axes spin[2] */
    spin?: ArrayLike<number>;
    /** Coulomb coefficient >= 0 */
    friction?: number;
    /** 0 to 1 */
    restitution?: number;
    /** [m/s^2] of `at` and `to` */
    acceleration?: ArrayLike<number>;
    /** [rad/s^2] */
    spinAcceleration?: ArrayLike<number>;
    /** [m/s] further velocity of the surface, as of a conveyor belt */
    surface?: ArrayLike<number>;
    /** collides with particles whose mask has a bit in common; 0 (default) means all bits */
    mask?: number;
}

/** What particles gave to a collider. */
export interface Impulse {
    /** [N s] */
    linear: Float64Array;
    /** [N m s] about `at` at the end of the call */
    angular: Float64Array;
}

/** A convex body. Particles stay outside it. */
export type Collider =
    | (Body & {
          shape: "plane";
          /**
           * out of the body; of any length; default [0, 1, 0]. If the square of its length differs from 1 by at most 1e-15, it is
           * used as it is, so setColliders(getColliders()) does not change it.
           */
          normal?: ArrayLike<number>;
      })
    | (Body & {
          shape: "sphere";
          /** [m] */
          radius: number;
      })
    | (Body & {
          shape: "capsule";
          /** [m] */
          radius: number;
          /** [m] the other end */
          to: ArrayLike<number>;
          /** [m/s] of the other end; default: as `velocity` */
          velocityTo?: ArrayLike<number>;
      })
    | (Body & {
          shape: "box";
          /** [m] half of its size along each axis, without the radius */
          half: ArrayLike<number>;
          /** 9 numbers, its unit axes; default: those of the scene */
          axes?: ArrayLike<number>;
          /** [m] rounds the edges; default 0 */
          radius?: number;
      });

export interface FrameOptions {
    /** Time of further steps is dropped; default: as many as there are in 0.25 s. */
    mostSteps?: number;
    /**
     * Moves pins and colliders. It is called once before the steps of a frame, and not if no step is due. `time` [s] is from
     * the time of the scene to the end of the frame: drive(i, target, time) with the present target. `dropped` [s] has been
     * dropped before that, by this frame or by frames that failed: transform() moves the scene by the motion of the target in this time.
     * If move() throws or is async, the frame fails.
     */
    move?: ((time: number, dropped: number) => void) | null;
}

export interface SceneDefinition {
    /** particles along x, y, z of a grid, for triangles() and textureCoordinates() */
    count?: readonly number[];
    /** default 3 */
    axes?: 1 | 2 | 3;
    /** [axes per particle] [m] x0, y0, z0, x1, ... */
    position: ArrayLike<number>;
    /** [axes per particle] [m/s]; default: at rest */
    velocity?: ArrayLike<number>;
    /** [kg] of every particle, or of each; default 1 */
    mass?: number | ArrayLike<number>;
    /** for each particle whether it ignores forces; default: none does */
    pinned?: ArrayLike<number | boolean>;
    links?: Links | readonly Link[];
    weightedLinks?: WeightedLinks;
    /** [m/s^2], of 3 numbers, or one for each axis */
    gravity?: ArrayLike<number>;
    /** [N s/m] >= 0, on every particle */
    drag?: number;
    /** [m/s] a step after which a particle is faster along an axis fails; 0: no limit */
    maxSpeed?: number;
    /** methods to be used; default: "euler", "symplectic-euler" and "leapfrog" */
    methods?: readonly Method[];
    /** enables pin, unpin, setMass, setLink, setLinks, cut and tear */
    editable?: boolean;
    /** links pull and never push: rope, net, sail */
    tensionOnly?: boolean;
    /** enables set("force", ...) */
    heldForces?: boolean;
    /** maximum number of colliders, at most 32; default 0 */
    colliders?: number;
    /** [m] of every particle or per particle, for contacts */
    particleRadius?: number | ArrayLike<number>;
    /** per particle, >= 0: factor of the friction of colliders; default 1 */
    particleFriction?: ArrayLike<number>;
    /** per particle an integer: it collides with colliders whose mask has a bit in common, 0: with none; default all bits */
    particleMask?: ArrayLike<number>;
    /** no second copy of the state: a step that fails loses it */
    noUndo?: boolean;
    force?: Force | null;
    /** Pass velocities to `force`. Leapfrog then evaluates forces twice a step. */
    forceUsesVelocity?: boolean;
    /** the component of `positions` that receives the first axis; default 0 */
    component?: number;
    /** [3 per particle] first contents of `positions`, for components that no axis writes; default 0 */
    base?: ArrayLike<number>;
}

export interface GridDefinition {
    /** particles along x, y, z */
    count:
        readonly [number] | readonly [number, number] | readonly [number, number, number] | readonly number[];
    /** default 3; 1 for a height field */
    axes?: 1 | 2 | 3;
    /** one axis, across the grid: height-field water */
    height?: boolean;
    /** [m] from one particle to the next */
    spacing: number;
    /** length over rest length of every link; default 1 */
    stretch?: number;
    /** default: structural links only */
    families?: readonly ("structural" | "shear" | "bend")[];
    /** [N/m] of every link */
    stiffness: number;
    /** [N s/m] of every link; default 0 */
    damping?: number;
    /** faces whose particles are pinned */
    pinned?: readonly ("firstX" | "lastX" | "firstY" | "lastY" | "firstZ" | "lastZ")[];
}

export interface Grid {
    axes: 1 | 2 | 3;
    count: [number, number, number];
    position: Float64Array;
    pinned: Uint8Array;
    links: LinkArrays;
    component?: number;
    base?: Float32Array;
}

/** A rope, a sheet or a soft body: a part of a definition. Particle (i, j, k) has index i + count[0] (j + count[1] k). */
export declare function grid(definition: GridDefinition): Grid;

export interface BendOptions {
    /** for each particle whether it is pinned: two next to each other are a clamp */
    pinned?: ArrayLike<number | boolean>;
    /** [s] damping over stiffness of each link; default 0 */
    dampingTime?: number;
}

/** Bending stiffness EI [N m^2] of a rod, straight at rest: hair, a cable. For `weightedLinks` of a definition. */
export declare function bendRod(
    position: ArrayLike<number>,
    rigidity: number,
    options?: BendOptions & { axes?: 1 | 2 | 3 },
): WeightedLinkArrays;

/** Bending stiffness D [N m] of a sheet: cloth, paper. `diagonals: false` costs half as much. */
export declare function bendGrid(
    grid: { count: readonly number[]; spacing: number },
    rigidity: number,
    options?: BendOptions & { diagonals?: boolean },
): WeightedLinkArrays;

/** Bending stiffness D [N m] of a flat triangle mesh, such as that of fromMesh(). */
export declare function bendMesh(
    position: ArrayLike<number>,
    triangles: ArrayLike<number>,
    rigidity: number,
    options?: BendOptions,
): WeightedLinkArrays;

/**
 * The links of a definition, followed by tethers to the nearest pinned particles. They limit the stretch of ropes and cloth at
 * a few steps per frame. `fraction`, by default 0.05, is their stiffness relative to the sum of the stiffness of their particle.
 */
export declare function tethers(definition: SceneDefinition, fraction?: number, slack?: number): LinkArrays;

/** Particles and links of a triangle mesh for drawing, whose vertices may be split at seams. */
export declare function fromMesh(mesh: {
    /** [3 per vertex] [m] */
    position: ArrayLike<number>;
    /** [3 per triangle] vertices */
    triangles: ArrayLike<number>;
    /** [N/m] of every link */
    stiffness: number;
    /** [N s/m] of every link; default 0 */
    damping?: number;
    /** [m] vertices that are not farther apart become one particle; default 0; null: none do */
    weld?: number | null;
}): {
    position: Float64Array;
    links: LinkArrays;
    /** of particles */
    triangles: Uint32Array;
    /** of each vertex */
    particleOf: Uint32Array;
};

/** The links of a definition, softened until dt is at most `fraction`, by default 0.5, of the stable step of leapfrog. */
export declare function soften(definition: SceneDefinition, dt: number, fraction?: number): LinkArrays;

/** Connected components. component[i] is the number of the component of particle i. Links without stiffness and damping do not connect. */
export declare function components(
    particles: number,
    links: Links | readonly Link[],
): { count: number; component: Uint32Array };

/** The state of a scene at one time, for Scene.restore(). */
export interface Snapshot {
    readonly time: number;
}

/**
 * A mass-spring system. Bad input throws a RangeError or TypeError and changes nothing. Steps that fail throw a RangeError with
 * the code "SPRING_ENONFINITE" or "SPRING_EUNSTABLE" and leave the scene as it was (unless it has `noUndo`).
 *
 * Memory is released by free(), by `using`, or when the scene is collected as garbage.
 */
export declare class Scene {
    constructor(definition: SceneDefinition);
    free(): void;
    [Symbol.dispose](): void;

    readonly axes: 1 | 2 | 3;
    readonly particles: number;
    readonly links: number;

    /** x, y, z of each particle: the same array for the life of the scene, refilled by everything that moves particles. */
    readonly positions: Float32Array;

    /** Advances by a number of steps, by default 1, of dt seconds. */
    advance(method: Method, dt: number, steps?: number): void;

    /**
     * Takes the steps that are due after `elapsed` more seconds, and returns their number: by default with leapfrog, and
     * with 1/60 s divided into equal steps of at most 1/240 s and at most half of the stable step, or a quarter with
     * `tensionOnly`.
     */
    frame(elapsed: number, options?: FrameOptions & { method?: Method; dt?: number }): number;

    /**
     * Takes the steps of dt that are due after `elapsed` more seconds and returns their number. A negative time counts as 0.
     * `positions` are interpolated between the last two steps. The last argument may be `mostSteps` alone. If a step fails, the
     * scene is as before the frame, and the time of the frame is dropped.
     */
    frame(method: Method, dt: number, elapsed: number, options?: FrameOptions | number): number;

    /** A lower bound of the stability limit [s] */
    stableStep(method?: Method): number;
    /** [s] */
    readonly time: number;
    /** [J]; `gravity` is 0 at the origin */
    readonly energy: { kinetic: number; elastic: number; gravity: number; total: number };
    /** Whether no particle is faster than `speed` or accelerates by more than `acceleration`. */
    atRest(speed: number, acceleration: number): boolean;

    /** A copy of the values of `count` particles, by default of all from `first` on, in double precision. */
    get(quantity: Quantity, first?: number, count?: number): Float64Array;
    set(quantity: Quantity, values: ArrayLike<number>, first?: number): void;

    /** Indices of triangles of a grid: of a sheet, or of the surface of a solid. */
    triangles(): Uint32Array;
    /** Two for each particle of a grid: from 0 to 1 along x and y */
    textureCoordinates(): Float32Array;

    /** Moves all particles by an affine map: the rows of [A b], 12 numbers, or the 16 elements of a Matrix4 of three.js. */
    transform(matrix: ArrayLike<number>): void;
    setGravity(gravity: ArrayLike<number>): void;

    /** The callback. Set it again after a change of the data that it reads. */
    force: Force | null;

    snapshot(): Snapshot;
    /** Returns to a snapshot of this scene. */
    restore(snapshot: Snapshot): void;

    /**
     * The state in a portable format, for load() in another page or process, or in C, Python or LuaJIT. The time of frame() that
     * no step has used is not part of it.
     */
    save(): ReturnType<Uint8Array["slice"]>;
    /**
     * Loads a state that was saved anywhere, from a scene of the same definition, which then continues bit-identically. It
     * throws if the state is damaged or does not fit, and names what differs. Values that it cannot check must be equal: drag,
     * maxSpeed, particleRadius and the force; also masses, pinned particles and link values, unless the scene is editable. Frames
     * start anew.
     */
    load(state: Uint8Array): void;
    /** Sets the time [s]. Colliders stay where they are. */
    setTime(t: number): void;

    pin(first: number, count?: number): void;
    unpin(first: number, count?: number): void;
    /** Sets a pinned particle's velocity so that it reaches `target` after `duration` seconds. null: it stops. */
    drive(particle: number, target: ArrayLike<number> | null, duration?: number): void;
    setMass(mass: ArrayLike<number>, first?: number): void;

    getLink(index: number): Required<Link>;
    getLinks(): LinkArrays;
    setLink(index: number, changes: { rest?: number; stiffness?: number; damping?: number }): void;
    setLinks(links: Links | readonly Link[], first?: number): void;
    /** Removes stiffness and damping. */
    cut(index: number): void;
    /** Cuts links longer than `stretch` times their rest length, one limit or one per link, and returns their indices. */
    tear(stretch: number | ArrayLike<number>): Uint32Array;
    components(): { count: number; component: Uint32Array };
    /** The first link between two particles; -1: none */
    findLink(a: number, b: number): number;
    /** Tension of a link [N], positive if the link pulls */
    tension(link: number): number;

    /** Replaces all colliders. They are given at their pose now, and move at their velocities until they are set again. */
    setColliders(colliders: readonly Collider[]): void;
    /** The colliders as they are now, as after load(): with all their fields, and their present poses and velocities. */
    getColliders(): Collider[];
    /** For each particle the colliders that it touched in the last step: bit i stands for collider i. */
    touching(first?: number, count?: number): Uint32Array;
    /** What particles gave to a collider in the last advance() or frame(). It is 0 after a frame without steps. */
    impulse(collider: number): Impulse;
}
