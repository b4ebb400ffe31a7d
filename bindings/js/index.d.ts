// SPDX-License-Identifier: MIT

/** The parameters of T, and no others. */
type Only<T> = T & { [K in Exclude<Names, keyof T>]?: never };
type Names =
    | ("stiffness" | "damping" | "mass" | "response" | "dampingFraction" | "settling" | "tolerance")
    | ("duration" | "bounce" | "hertz" | "dampingRatio" | "halfLife");

/** Parameters of a spring, in one of six forms. Times are in seconds. */
export type SpringParameters =
    | Only<{
          /** >= 0 */
          stiffness: number;
          /** >= 0 */
          damping: number;
          /** > 0; default 1 */
          mass?: number;
      }>
    | Only<{
          /** 2 pi / undamped angular frequency; > 0 */
          response: number;
          /** damping ratio, >= 0; default 1, which does not overshoot */
          dampingFraction?: number;
      }>
    | Only<{
          /** 2 pi / undamped angular frequency; > 0; default 0.5 */
          duration?: number;
          /** > -1 and <= 1; default 0, which does not overshoot. 1 never stops. */
          bounce?: number;
      }>
    | Only<{
          /** undamped frequency, > 0 */
          hertz: number;
          /** >= 0; default 1, which does not overshoot */
          dampingRatio?: number;
      }>
    | Only<{
          /** time in which the amplitude halves; > 0 */
          halfLife: number;
          /** > 0; default 1, which does not overshoot */
          dampingRatio?: number;
      }>
    | Only<{
          /** time after which a value that starts at rest stays within `tolerance` of the way; > 0 */
          settling: number;
          /** > 0; default 1, which does not overshoot */
          dampingRatio?: number;
          /** > 0 and < 1; default 0.001 */
          tolerance?: number;
      }>;

export interface Tolerances {
    /** A value settles if its distance from the target stays at most this; default 1/10000 of the size of the motion. */
    restDelta?: number;
    /** A value settles if its speed per second stays at most this; default 1/1000 of the size of the motion. */
    restSpeed?: number;
}

/** Each parameter is a number, or an array with a number for each value. */
type Each<T> = T extends unknown
    ? { [K in keyof T]: [Exclude<T[K], undefined>] extends [never] ? T[K] : T[K] | ArrayLike<number> }
    : never;

export type SpringsParameters = Each<SpringParameters>;

interface Callbacks {
    /** see Spring.clamp; default false */
    clamp?: boolean;
    /** see Spring.onRest; default null */
    onRest?: ((spring: Spring) => void) | null;
}

interface SetCallbacks {
    /** see Springs.clamp; default false */
    clamp?: boolean;
    /** see Springs.onRest; default null */
    onRest?: ((i: number, springs: Springs) => void) | null;
}

export type SpringOptions = SpringParameters & Tolerances & Callbacks;

export type SpringsOptions = SpringsParameters & Each<Tolerances> & SetCallbacks;

/** Some of the parameters of one form. */
type Some<T> = T extends unknown ? Partial<T> : never;

/** Options of Spring.set(): parameters of a form, or some of the parameters of the form that the spring has. */
export type SpringChanges = Some<SpringParameters> & Tolerances & Callbacks;

export type SpringsChanges = Each<Some<SpringParameters>> & Each<Tolerances> & SetCallbacks;

/** A value that follows a target. Bad input throws a RangeError or TypeError and changes nothing. */
export declare class Spring {
    /** At rest on its target `value`, which is 0 by default. The default options are `{ duration: 0.5 }`. */
    constructor(value?: number, options?: SpringOptions);

    /** The value. A new value keeps velocity and target. */
    value: number;

    /** Velocity, in units of the value per second. */
    velocity: number;

    /** The place of the target at the end of the next step. A new target keeps value and velocity. */
    target: number;

    /**
     * The mean velocity of the target in the next step, (target - previous target)/dt, default 0. To follow a moving target
     * without lag, set both before each step.
     */
    targetVelocity: number;

    /** Whether the value is at rest on its target. step() has no effect then. A new target makes it false until a step. */
    readonly settled: boolean;

    /**
     * Resolves when the value comes to rest, also by jump() and finish(), or at once if it is at rest. If the target changes
     * before, it resolves when the value is at rest on the new target.
     */
    readonly finished: Promise<void>;

    /** Stop at the target instead of overshooting, however long the step. A value on its target stays there. */
    clamp: boolean;

    /** Called each time the value comes to rest on its target, by step() or finish(), but not by jump(). */
    onRest: ((spring: Spring) => void) | null;

    /**
     * Changes the options that are given. Value, velocity and target stay. Parameters of another form replace those of the
     * spring: after `{ stiffness, damping }`, `{ damping: 10 }` keeps the stiffness, and `{ hertz: 2 }` does not keep the damping.
     */
    set(options: SpringChanges): void;

    /** Places value and target at `value`, at rest. Resolves `finished`, but does not call onRest. */
    jump(value: number): void;

    /** Ends a gesture: sets the velocity, and the target if it is given. */
    release(velocity: number, target?: number): void;

    /** Ends the motion: places the value on its target, or with stiffness 0 where damping would stop it. */
    finish(): void;

    /**
     * Seconds until the value settles, if frames are short: 0 if it is settled. Infinity if it never does, if the target has a
     * velocity, and if a tolerance is 0.
     */
    settlingTime(): number;

    /**
     * Advances by `dt` seconds, of any length, and returns the value. A negative `dt` integrates backwards. Value and velocity
     * are bit-identical to those of spring_follow() in C until the spring settles. If they would overflow, step() throws a RangeError and changes
     * nothing. A settled spring stays at rest on its target.
     */
    step(dt: number): number;
}

/**
 * Many values, each with its own target. animate() detects changes only if you write `springs.target[i] = 1`, so do not
 * keep an array in a variable.
 */
export declare class Springs {
    /** Values, velocities and targets are 0. The default options are `{ duration: 0.5 }`. */
    constructor(count: number, options?: SpringsOptions);

    // If one of the four numbers of a value has changed since the last step, step() computes the size of its motion anew.
    readonly value: Float64Array;
    readonly velocity: Float64Array;
    readonly target: Float64Array;
    readonly targetVelocity: Float64Array;

    /** see Spring.clamp */
    clamp: boolean;

    /**
     * Called for each value that comes to rest on its target, after the step. If a call throws, the others follow, and step() or
     * finish() then throws the first error.
     */
    onRest: ((i: number, springs: Springs) => void) | null;

    /** Whether value i is at rest on its target. A property of Spring, and a method here. */
    settled(i: number): boolean;

    /** Changes the options that are given, as Spring.set(). */
    set(options: SpringsChanges): void;

    /**
     * Ends all motions, as finish() of Spring. If a target is not finite, or a value without stiffness, that value keeps its state,
     * and finish() throws a RangeError.
     */
    finish(): void;

    /**
     * Advances by `dt` seconds, of any length, and returns the number of values that still move. A value is placed on its target
     * when it is within the tolerances at the end of a step, as by spring_batch_follow_moving() in C. If a target is not finite or
     * a value would overflow, that value keeps its state, the others are advanced, and step() throws a RangeError.
     */
    step(dt: number): number;
}

/** The velocity of a pointer, by least squares over its positions of the last 100 ms. Use one for each axis. */
export declare class VelocityTracker {
    /** `time` is in milliseconds, as `event.timeStamp`. */
    add(position: number, time: number): void;
    /**
     * Units per second. `time` is in milliseconds, by default that of the last position. A pointer that has not moved for 100 ms
     * is at rest.
     */
    velocity(time?: number): number;
}
