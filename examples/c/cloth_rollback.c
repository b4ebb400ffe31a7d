/* SPDX-License-Identifier: MIT */
/*
 * Cloth in a network game. The input of the other player arrives six frames late and is predicted until then. After a
 * wrong prediction, the cloth is reset to that frame and simulated again. The result is bit-identical to a run in which
 * every input arrives in time.
 *
 *     cc -std=c11 cloth_rollback.c -lspringstep -lm -o cloth_rollback
 *
 * A scene holds no pointer to itself, so a snapshot is a memcpy().
 */
#include <springstep/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 24, N = SIDE * SIDE, FRAMES = 90, LATE = 6, STEPS = 6 };
static const double dt = 1.0 / 360; /* [s]; a frame has STEPS steps */

static void must(spring_status status)
{
    if (status == SPRING_OK)
        return;
    fprintf(stderr, "%s\n", spring_status_string(status));
    exit(1);
}

/* The actual input of the other player: move the pinned edge back, hold it, move it forth. */
static int input(int frame)
{
    return frame / 17 % 3 - 1;
}

static void simulate(spring_scene *cloth, int push)
{
    double v[SIDE][3] = {{0}}; /* [m/s] of the pinned edge, particles 0 ... SIDE - 1 */
    for (int i = 0; i < SIDE; i++)
        v[i][2] = 0.8 * push;
    must(spring_scene_set(cloth, SPRING_VELOCITY, v[0], 0, 0, SIDE));
    must(spring_scene_advance(cloth, SPRING_LEAPFROG, dt, STEPS));
}

/* FNV-1a hash of all positions and velocities. */
static unsigned long long digest(const spring_scene *cloth)
{
    static double state[2][3 * N];
    must(spring_scene_get(cloth, SPRING_POSITION, state[0], 0, 0, N));
    must(spring_scene_get(cloth, SPRING_VELOCITY, state[1], 0, 0, N));
    unsigned char bytes[sizeof state];
    memcpy(bytes, state, sizeof state);
    unsigned long long hash = 0xcbf29ce484222325;
    for (size_t i = 0; i < sizeof bytes; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3;
    return hash;
}

int main(void)
{
    const spring_grid sheet = {.count = {SIDE, SIDE},
                               .spacing = 0.05,
                               .families = SPRING_GRID_STRUCTURAL | SPRING_GRID_SHEAR,
                               .stiffness = 200,
                               .damping = 0.02,
                               .pinned = SPRING_GRID_FIRST_Y};
    static double position[3 * N];
    static uint8_t pinned[N];
    size_t particles, links, bytes;
    must(spring_grid_size(&sheet, &particles, &links));
    spring_link *link = malloc(links * sizeof *link);
    if (link == NULL)
        return 1;
    must(spring_grid_fill(&sheet, position, pinned, link));
    const spring_scene_def def = {.particles = particles,
                                  .links = links,
                                  .position = position,
                                  .mass_all = 0.01,
                                  .pinned = pinned,
                                  .link = link,
                                  .gravity = {0, 9.81, 0}}; /* the sheet hangs along +y */
    must(spring_scene_bytes(&def, &bytes));
    unsigned char *memory = malloc((LATE + 2) * bytes), *snapshots = memory + 2 * bytes;
    spring_scene *in_time, *cloth;
    if (memory == NULL)
        return 1;
    must(spring_scene_init(memory, bytes, &def, &in_time));
    must(spring_scene_init(memory + bytes, bytes, &def, &cloth));
    printf("a snapshot is %zu bytes\n", bytes);

    int used[FRAMES], rollbacks = 0, replayed = 0;
    for (int now = 0; now < FRAMES + LATE; now++) {
        const int arrived = now - LATE; /* the input of this frame arrives now */
        if (arrived >= 0 && used[arrived] != input(arrived)) {
            const int end = now < FRAMES ? now : FRAMES;
            memcpy(cloth, snapshots + (size_t)(arrived % LATE) * bytes, bytes);
            for (int frame = arrived; frame < end; frame++) {
                used[frame] = input(arrived); /* known for the first frame, a new guess for the others */
                memcpy(snapshots + (size_t)(frame % LATE) * bytes, cloth, bytes);
                simulate(cloth, used[frame]);
            }
            rollbacks++;
            replayed += end - arrived;
            printf("frame %d was wrong: replayed %d, now %016llx\n", arrived, end - arrived, digest(cloth));
        }
        if (now >= FRAMES)
            continue;
        simulate(in_time, input(now));
        used[now] = arrived >= 0 ? input(arrived) : 0; /* guess: the last known input */
        memcpy(snapshots + (size_t)(now % LATE) * bytes, cloth, bytes);
        simulate(cloth, used[now]);
        if (now % 17 == 2 || now % 17 == 10) /* while a guess is wrong, and later */
            printf("frame %d  in time %016llx  guessed %016llx\n", now, digest(in_time), digest(cloth));
    }
    printf("%d rollbacks, %d frames replayed\n", rollbacks, replayed);
    printf("at the end  in time %016llx  replayed %016llx\n", digest(in_time), digest(cloth));
    free(memory);
    free(link);
    return 0;
}
