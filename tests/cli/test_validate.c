/* SPDX-License-Identifier: MIT */
/*
 * Tests that spring-validate is reliable: it runs all its cases, its bounds are not so wide that they always hold, and
 * it fails with a wrong library (wrong_advance.c). The arguments are the paths of both programs.
 */
#define _POSIX_C_SOURCE 200809L /* popen(), setenv() */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "check.h"
#include "harness/cases.h"
#include "harness/scenes.h"
#include "test_methods.h"

typedef struct row {
    char of[40], method[20], witness[20], verdict[10], reason[80], shape[10];
    double error, bound;
} row;

static const char *right_program, *wrong_program;
enum { most_rows = 5000 };
static row rows[most_rows];
static size_t row_count;

/* Fills rows[], returns the exit status. */
static int validate(const char *program, const char *options)
{
    char command[4096], line[1000];
    snprintf(command, sizeof command, "'%s' %s", program, options);
    FILE *output = popen(command, "r");
    CHECK(output != NULL, "it starts");
    row_count = 0;
    while (output != NULL && fgets(line, sizeof line, output) != NULL) {
        row *r = &rows[row_count];
        if (sscanf(line, "%39[^\t]\t%19s\t%19s\t%*s\t%*s\t%lf\t%lf\t%9s\t%79[^\t]\t%*s\t%*s\t%9s", r->of, r->method,
                   r->witness, &r->error, &r->bound, r->verdict, r->reason, r->shape) == 8 &&
            row_count + 1 < most_rows)
            row_count++;
    }
    CHECK(row_count + 1 < most_rows, "room for all rows");
    const int status = output != NULL ? pclose(output) : -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static unsigned count(const char *of, const char *method, const char *witness, const char *verdict)
{
    unsigned found = 0;
    for (const row *r = rows; r < rows + row_count; r++)
        if ((of == NULL || strcmp(r->of, of) == 0) && (method == NULL || strcmp(r->method, method) == 0) &&
            (witness == NULL || strcmp(r->witness, witness) == 0) &&
            (verdict == NULL || strcmp(r->verdict, verdict) == 0))
            found++;
    return found;
}

/* Nothing is left out: every case that is not slow, with every method that it takes. Each has the reference that every
   case has, once for a spring and at least once for a scene; tests/cli has the names of all references. */
static void whole_catalogue(void)
{
    CHECK(count(NULL, NULL, NULL, "pass") == row_count, "no fail, no skip");
    CHECK(case_count >= 25 && scene_case_count >= 25 && row_count >= 350, "as much as was promised");
    for (int m = 0; m < SPRING_METHOD_COUNT; m++) {
        const char *method = spring_method_name((spring_method)m);
        for (const validation_case *c = cases; c < cases + case_count; c++)
            if (!c->slow && case_takes(c, (spring_method)m)) {
                CHECK(count(c->name, method, "solution", NULL) == 1, c->name);
                CHECK(count(c->name, method, "iterate", NULL) == (m != SPRING_EXACT), c->name);
                CHECK(count(c->name, method, "drive", NULL) == (c->drive > 0), c->name);
                CHECK(!c->external || count(c->name, NULL, "gsl-rk4", NULL) == 1, c->name);
            }
        for (const scene_case *c = scene_cases; c < scene_cases + scene_case_count; c++)
            if (!c->slow && scene_case_steps(c, (spring_method)m) > 0) {
                CHECK(count(c->name, method, "definition", NULL) == 1, c->name);
                CHECK(c->formula == NULL || count(c->name, method, c->formula, NULL) > 0, c->name);
                CHECK((count(c->name, method, "cvode-adams", NULL) == 1) == c->external, c->name);
            }
    }
}

static spring_method method_named(const char *name)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++)
        if (strcmp(spring_method_name(spring_method_at(i)), name) == 0)
            return spring_method_at(i);
    CHECK(false, name);
    return no_method;
}

static int order_of(const char *method)
{
    return spring_method_describe(method_named(method))->order;
}

/* A bound that no error comes near proves nothing: for each method and reference some error is within a factor of 100,
   of springs and of scenes. The definition does much the same operations as the library, and rounds alike: there,
   within 1000. So it is with a method that takes steps for its order which no undamped mode bears: bounds grow with
   modes that are not in the motion. */
static void bounds_are_near(void)
{
    for (const row *r = rows; r < rows + row_count; r++) {
        double nearest = 0;
        for (const row *other = rows; other < rows + row_count; other++)
            if (strcmp(other->method, r->method) == 0 && strcmp(other->witness, r->witness) == 0 &&
                strcmp(other->shape, r->shape) == 0 && other->error > nearest * other->bound)
                nearest = other->error / other->bound;
        const bool grows = order_of(r->method) > 1 && never_stable(method_named(r->method));
        CHECK(nearest >= (grows || strcmp(r->witness, "definition") == 0 ? 0.001 : 0.01), r->witness);
    }
}

/* What rounding may add to the bounds of a scene and method, as spring-validate has it: by the bound that its
   definition has twice, of R = 2^order times the steps and extrapolated. */
static double rounding_of(const row *of, double R)
{
    for (const row *r = rows; r < rows + row_count; r++)
        if (strcmp(r->of, of->of) == 0 && strcmp(r->method, of->method) == 0 && strcmp(r->witness, "definition") == 0)
            return 4 * r->bound * (R + 1) / (R - 1);
    return 0;
}

/* Truncation errors of scenes have to fall like h^order to within half: so much the bounds on them allow. */
static void bounds_fall(void)
{
    unsigned pairs = 0;
    for (const row *r = rows; r + 1 < rows + row_count; r++) {
        if (strcmp(r->reason, "truncation measured at 2h and h") != 0)
            continue;
        const double factor = ldexp(1, order_of(r->method));
        CHECK(strncmp(r[1].reason, "truncation measured at 4h", 25) == 0, "the next row is for half the step");
        const double rounded = rounding_of(r, factor);
        CHECK((r[1].bound - rounded) * factor <= 1.5 * (r->bound - rounded), r->of);
        pairs++;
    }
    CHECK(pairs >= 25, "of every method and scene that has a solution");
}

/* The extremes that the catalogue is there for. */
static void extremes(void)
{
    static const double fractions[] = {0.5, 0.99, 0.999999, 1.000001, 3}; /* of the stable step */
    static const double ratios[] = {0, 1e-12, 0.1, 1 - 1e-12, 1, 1 + 1e-12, 10, 1e4};
    bool with_fraction[5] = {false}, with_ratio[8] = {false};
    for (const validation_case *c = cases; c < cases + case_count; c++) {
        for (int i = 0; i < 5; i++)
            with_fraction[i] = with_fraction[i] || c->stable_fraction == fractions[i];
        for (int i = 0; i < 8; i++)
            with_ratio[i] = with_ratio[i] || c->damping_ratio == ratios[i];
    }
    for (int i = 0; i < 5; i++)
        CHECK(with_fraction[i], "steps on both sides of the limit");
    for (int i = 0; i < 8; i++)
        CHECK(with_ratio[i], "damping of every kind");
}

static void right(void)
{
    CHECK(validate(right_program, "--quick") == 0, "everything holds");
    whole_catalogue();
    bounds_are_near();
    bounds_fall();
}

/* A wrong library, with cases that have every reference between them: status 1, each reference fails some row, and all
   rows of the one named (NULL: of all) fail. */
static void wrong(const char *way, const char *const *wrong_cases, size_t wrong_case_count,
                  const char *reference_that_sees_all)
{
    setenv("WRONG", way, 1);
    for (size_t i = 0; i < wrong_case_count; i++) {
        CHECK(validate(wrong_program, wrong_cases[i]) == 1, way);
        CHECK(row_count > 0, way);
        for (const row *r = rows; r < rows + row_count; r++) {
            const bool blunt = strcmp(r->witness, "drive") == 0; /* its bound is what sampling the drive costs */
            CHECK(blunt || count(NULL, NULL, r->witness, "fail") > 0, r->witness);
            if (reference_that_sees_all == NULL || strcmp(r->witness, reference_that_sees_all) == 0)
                CHECK(strcmp(r->verdict, "fail") == 0, r->witness);
        }
    }
}

static void wrong_spring(const char *way, const char *reference_that_sees_all)
{
    static const char *const wrong_cases[] = {"--case brisk-60", "--case beating-middle"};
    wrong(way, wrong_cases, 2, reference_that_sees_all);
}

static void wrong_scene(const char *way, const char *reference_that_sees_all)
{
    static const char *const wrong_cases[] = {"--case double-pendulum", "--case resonant-drive", "--case pair",
                                              "--case pair-damped", "--case chain-10"};
    wrong(way, wrong_cases, sizeof wrong_cases / sizeof wrong_cases[0], reference_that_sees_all);
}

static void wrong_in_every_row(void)
{
    wrong_spring("refused", NULL);
    wrong_spring("lost", NULL);
    wrong_scene("refused", NULL);
    wrong_scene("lost", NULL);
    wrong_scene("unmoved", NULL);
}

static void slightly_wrong(void)
{
    wrong_spring("unmoved", "iterate");
    wrong_spring("x off", "iterate");
    wrong_spring("v off", "iterate");
    wrong_scene("x off", "definition");
}

/* Every reference notices a method that is only one of a lower order, bounds taken from the runs themselves included. A
   reference may know positions alone, so not every one notices a wrong velocity. */
static void wrong_order(void)
{
    wrong_scene("lower order", "definition");
    setenv("WRONG", "v off", 1);
    CHECK(validate(wrong_program, "--case double-pendulum") == 1, "a wrong velocity");
    CHECK(count(NULL, NULL, "definition", "fail") == count(NULL, NULL, "definition", NULL), "a wrong velocity");
    CHECK(count(NULL, NULL, "cvode-adams", "fail") >= 2, "a wrong velocity");
}

int main(int argc, char **argv)
{
    static const test tests[] = {
        {"the whole catalogue, with bounds that can be missed", right},
        {"the extremes of the catalogue", extremes},
        {"a library that does not work fails in every row", wrong_in_every_row},
        {"a library that is slightly wrong is noticed by every reference", slightly_wrong},
        {"so are scenes by a method of lower order, and wrong velocities", wrong_order},
    };
    if (argc != 3)
        return EXIT_FAILURE;
    right_program = argv[1];
    wrong_program = argv[2];
    return RUN_TESTS("validate", tests);
}
