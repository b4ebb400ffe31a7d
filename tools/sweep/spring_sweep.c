/* SPDX-License-Identifier: MIT */
/*
 * spring-sweep: measures one spring or a preset scene at every point of a grid of parameters.
 *
 * Points are independent. The grid is divided into blocks, and each part consists of every N-th block. Its file has a
 * header, and a line "# block K" after the rows of each block. Parts are computed by independent processes, on one or
 * several machines, and joined in the order of the grid. The joined output does not depend on the number of parts. The
 * file of a part is written under a temporary name and renamed when it is complete, so any part can be repeated.
 */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/cli.h"
#include "scenes/presets.h"
#include "sweep/grid.h"

enum { most_parts = 1000000, most_jobs = 1024, header_size = 65536 };

static cli_words over, methods, measures, part, joined;
static uint64_t jobs; /* 0: not given */
static int scene;
static const char *scenes[preset_kinds + 2]; /* filled in before options are read */
static bool list;

static const cli_option options[] = {
    {"over", CLI_WORDS, .words = &over, .value = "NAME=A:B:N",
     .help = "an axis: N values from A to B; A:B:log:N with equal ratios; A,B,...\n"
             "With several axes, the first axis changes slowest. --list prints the names."},
    {"scene", CLI_CHOICE, .choice = &scene, .choices = scenes, .value = "S",
     .help = "one spring, or rope, cloth, jelly, chain, water"},
    {"method", CLI_WORDS, .words = &methods, .value = "M,...",
     .help = "methods, separated by commas, or all (default: all)"},
    {"measure", CLI_WORDS, .words = &measures, .value = "C,...",
     .help = "additional columns, separated by commas\n"
             "These are available: steps, force_evaluations, dt_s, stable_step_s, explode_time_s, settling_time_s."},
    {"jobs", CLI_COUNT, .count = &jobs, .value = "J", .least = 1, .most = most_jobs, .unstamped = true,
     .help = "run J processes on this machine; requires --output\n"
             "Finished parts are stored in FILE.1-of-N, FILE.2-of-N, ... until all are complete. The same command\n"
             "continues an incomplete sweep, with any number of jobs."},
    {"part", CLI_WORDS, .words = &part, .value = "I/N", .unstamped = true,
     .help = "compute only part I of N; requires --output\n"
             "The file appears when the part is complete. If it exists, nothing is computed."},
    {"join", CLI_WORDS, .words = &joined, .value = "FILE...", .unstamped = true,
     .help = "write the rows of all parts, in the order of the grid"},
    {"list", CLI_FLAG, .flag = &list, .help = "print the parameters of the scene, and exit", .unstamped = true},
    {.name = NULL},
};

static const cli_program program = {
    .name = "spring-sweep",
    .summary = "Simulate a spring, or a scene, at every point of a grid of parameters.",
    .details = "The rows are identical to the last byte for any number of parts and jobs, on any machine. If a run\n"
               "with --jobs or --part is interrupted, the same command continues it.\n\n"
               "A spring has omega = 1/s, and runs for 10 periods by default. A scene runs for 2 s with 8 steps per\n"
               "frame of 1/60 s by default, and is examined after each frame. Otherwise it is as in spring-scene.",
    .columns = "omega_dt method error energy_error status",
    .meaning = "The first columns are the parameters of the axes, here omega_dt.\n\n"
               "error: for a spring, the error relative to the exact solution, for the worst start. For a scene, the\n"
               "error relative to RK4, divided by the size of the motion. RK4 has steps of at most a sixteenth of\n"
               "its stable step and of the stable step of leapfrog. Its own error is 1e-9 for slow motion (a hanging\n"
               "cloth), and up to 2e-4 for the fastest motion (waves as short as links).\n\n"
               "force_evaluations: one per step for leapfrog in scenes. With heavily damped links, a step also\n"
               "evaluates damping alone, which is not counted.\n\n"
               "energy_error: the largest energy error, with its sign, relative to the initial energy, or for a\n"
               "scene to its largest kinetic energy. settling_time_s: the time after which a spring stays below 1 %\n"
               "of the start, and a scene below 1 % of its largest speed.\n\n"
               "status: stable; growing (at or above the stable step); exploded (at or above the stable step, with a\n"
               "hundred times the energy; for a scene, ten times the correct kinetic energy, or numbers that are not\n"
               "finite; errors are measured until then); unsupported; no_step (no step is accurate enough, or the\n"
               "stable step is 0); too_long; invalid (the library rejects the numbers, or nothing moves in the\n"
               "scene). Unknown values are nan.",
    .shown = {"omega_dt", "error"},
    .examples = {"--over omega_dt=0.01:3:log:50 damping_ratio=0:2:21 -o map.tsv",
                 "--scene rope --over stiffness=1e2:1e4:log:5 steps_per_frame=1,2 --jobs 2 -o rope.tsv",
                 "--over tolerance=1e-6:0.1:log:6 periods=1,10,100 --measure force_evaluations"},
    .options = options,
    .stamps_itself = true,
};

/* --------------------------------------------------------------------------------------------------------- the grid */

static void check(bool done, const char *option, const grid *g)
{
    if (!done)
        cli_fail(CLI_USAGE, "--%s: %s", option, g->message);
}

static void make_grid(grid *g)
{
    grid_init(g);
    check(grid_set_scene(g, scenes[scene]), "scene", g);
    for (size_t i = 0; i < over.count; i++)
        check(grid_add_axis(g, over.word[i]), "over", g);
    if (methods.count == 0)
        check(grid_add_methods(g, "all"), "method", g);
    for (size_t i = 0; i < methods.count; i++)
        check(grid_add_methods(g, methods.word[i]), "method", g);
    for (size_t i = 0; i < measures.count; i++)
        check(grid_add_measures(g, measures.word[i]), "measure", g);
    check(grid_finish(g), "over", g);
}

static void list_parameters(void)
{
    cli_table *table = cli_open_output();
    cli_columns(table, "name column least most whole meaning");
    for (int p = 0; p < SWEEP_PARAMETERS; p++) {
        const sweep_parameter_info *info = &sweep_parameters[p];
        if (sweep_has(scene, (sweep_parameter)p))
            cli_row(table, "%s\t%s\t%.17g\t%.17g\t%d\t%s", info->name, info->column, info->least, info->most,
                    info->whole, info->help);
    }
    cli_finish();
}

/* The header of the output, with the part number in a part. It omits the compiler, since rows do not depend on it. */
static void print_header(char *text, size_t size, const grid *g, uint64_t number, uint64_t parts)
{
    char columns[1000] = "", line[100] = "";
    for (size_t i = 0; i < g->axes; i++)
        strcat(strcat(columns, sweep_parameters[g->axis[i].parameter].column), "\t");
    strcat(columns, "method\terror\tenergy_error\tstatus");
    for (size_t i = 0; i < g->measures; i++)
        strcat(strcat(columns, "\t"), sweep_measure_names[g->measure[i]]);
    strcat(columns, "\n");
    if (parts > 0)
        snprintf(line, sizeof line, "# part %" PRIu64 " of %" PRIu64 ", %" PRIu64 " blocks\n", number, parts,
                 g->blocks);
    if (snprintf(text, size, "# springstep %s, %s\n# command: %s\n%s%s", spring_version(), program.name,
                 cli_stamped_command(), line, columns) >= (int)size)
        cli_fail(CLI_USAGE, "--over: the description of these axes is too long");
}

/* ------------------------------------------------------------------------------------------------------------ parts */

/* The line in which two headers differ. */
static int different_line(const char *a, const char *b, const char **line_a, const char **line_b)
{
    size_t same = 0, line = 0;
    for (; a[same] == b[same] && a[same] != '\0'; same++)
        if (a[same] == '\n')
            line = same + 1;
    *line_a = a + line;
    *line_b = b + line;
    return (int)strcspn(*line_a, "\n");
}

/* Opens the file of a part at its first block. NULL: there is no file, or it ends within the header. Any other file is an
   error, because it must not be replaced. */
static FILE *open_part(const char *path, const char *header)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return NULL;
    FILE *in = S_ISREG(status.st_mode) ? fopen(path, "r") : NULL;
    if (in == NULL)
        cli_fail(CLI_IO, "cannot write \"%s\": a part should be a file that can be read and replaced", path);
    char start[header_size];
    const size_t length = strlen(header), read = fread(start, 1, length, in);
    start[read] = '\0';
    const char *own, *wanted;
    const int width = different_line(start, header, &own, &wanted);
    if (memcmp(start, header, read) != 0)
        cli_fail(CLI_IO, "\"%s\" exists, but is not this part of this sweep: it has \"%.*s\" instead of \"%.*s\"", path,
                 width, own, (int)strcspn(wanted, "\n"), wanted);
    if (read == length)
        return in;
    fclose(in);
    return NULL;
}

static void check_part(const char *path, const char *header)
{
    FILE *in = open_part(path, header);
    if (in != NULL)
        fclose(in);
}

/* Writes text that ends with "\n". */
static void write_text(cli_table *table, const char *text, size_t length)
{
    if (length > 0)
        cli_row(table, "%.*s", (int)length - 1, text);
}

/* Copies the rows of a block, or reads them if table is NULL. False: the next block of the file is incomplete, has
   lost rows, or is another block. */
static bool copy_block(FILE *in, uint64_t block, cli_table *table)
{
    char line[4096], end[80];
    for (uint64_t rows = 0; fgets(line, sizeof line, in) != NULL; rows++) {
        const size_t length = strlen(line);
        if (length == 0 || line[length - 1] != '\n' || line[0] == '#') {
            snprintf(end, sizeof end, "# block %" PRIu64 ", %" PRIu64 " rows\n", block, rows);
            return strcmp(line, end) == 0;
        }
        if (table != NULL)
            write_text(table, line, length);
    }
    return false;
}

/* Returns true if the file has all blocks of a part, and nothing else. Closes the file. */
static bool is_complete(FILE *in, uint64_t number, uint64_t parts, uint64_t blocks)
{
    bool complete = true;
    for (uint64_t block = number - 1; complete && block < blocks; block += parts)
        complete = copy_block(in, block, NULL);
    complete = complete && getc(in) == EOF;
    fclose(in);
    return complete;
}

/* Prints NaN without sign, because the sign of 0/0 differs between processors. Returns the number of characters. */
static int print_number(char *text, double x)
{
    return isnan(x) ? sprintf(text, "\tnan") : sprintf(text, "\t%.17g", x);
}

static void write_block(cli_table *table, const grid *g, sweep_memory *memory, uint64_t block)
{
    double value[SWEEP_PARAMETERS];
    sweep_result results[SPRING_METHOD_COUNT];
    const uint64_t first = block * g->points_of_block, count = grid_block_size(g, block);
    for (uint64_t point = first; point < first + count; point++) {
        if (memory == NULL || !grid_measure(g, memory, point, 1, value, results))
            cli_fail(CLI_FAILED, "out of memory");
        for (size_t k = 0; k < g->methods; k++) {
            const double *number = results[k].number;
            char line[(SWEEP_PARAMETERS + SWEEP_MEASURES) * 32 + 100], *end = line;
            for (size_t i = 0; i < g->axes; i++)
                end += sprintf(end, "%.17g\t", value[i]);
            end += sprintf(end, "%s", spring_method_name(g->method[k]));
            end += print_number(end, number[SWEEP_ERROR]);
            end += print_number(end, number[SWEEP_ENERGY_ERROR]);
            end += sprintf(end, "\t%s", sweep_status_names[results[k].status]);
            for (size_t i = 0; i < g->measures; i++)
                end += print_number(end, number[g->measure[i]]);
            cli_row(table, "%s", line);
        }
    }
}

/* Writes every stride-th block from `first`, numbered if the table is a part; NULL: all are there already. A byte for
   each block goes to the file descriptor `done`, or to the progress if it is negative. If the process that reads it has
   ended, this process ends by SIGPIPE. */
static void do_blocks(cli_table *table, const grid *g, uint64_t first, uint64_t stride, bool numbered, int done)
{
    sweep_memory *memory = sweep_memory_new();
    for (uint64_t block = first; block < g->blocks; block += stride) {
        if (table != NULL)
            write_block(table, g, memory, block);
        if (table != NULL && numbered)
            cli_row(table, "# block %" PRIu64 ", %" PRIu64 " rows", block, grid_block_size(g, block) * g->methods);
        if (done < 0)
            cli_progress((double)(block + 1) / (double)g->blocks);
        else if (write(done, "", 1) < 0)
            cli_fail(CLI_IO, "the parent process has exited");
    }
    sweep_memory_free(memory);
}

static void do_part(const grid *g, const char *path, uint64_t number, uint64_t parts, int done)
{
    char header[header_size];
    print_header(header, sizeof header, g, number, parts);
    FILE *in = open_part(path, header);
    cli_table *table = in != NULL && is_complete(in, number, parts, g->blocks) ? NULL : cli_open_file("output", path);
    if (table != NULL)
        write_text(table, header, strlen(header));
    do_blocks(table, g, number - 1, parts, true, done);
    if (table != NULL) {
        check_part(path, header);
        cli_close(table);
    }
}

static uint64_t read_number(const char *text, char **end)
{
    errno = 0;
    const unsigned long long number = text[0] >= '0' && text[0] <= '9' ? strtoull(text, end, 10) : 0;
    return errno == 0 ? number : 0;
}

static void do_one_part(const grid *g)
{
    char *end = NULL;
    const char *text = part.word[0];
    if (part.count > 1)
        cli_fail(CLI_USAGE, "--part: \"%s\" and \"%s\": a process computes only one part", text, part.word[1]);
    const uint64_t number = read_number(text, &end);
    const uint64_t parts = number > 0 && *end == '/' ? read_number(end + 1, &end) : 0;
    if (parts == 0 || *end != '\0' || number > parts || parts > most_parts)
        cli_fail(CLI_USAGE, "--part: \"%s\" is not I/N with 1 <= I <= N <= %d", text, most_parts);
    if (cli_output_path() == NULL)
        cli_fail(CLI_USAGE, "--part: requires --output, the file of the part");
    do_part(g, cli_output_path(), number, parts, -1);
}

/* ------------------------------------------------------------------------------------------------------------- join */

/* The file of a part. It is opened for each block, because there can be more parts than open files. */
typedef struct place {
    const char *path; /* NULL: missing */
    long long next;   /* position of the next block */
} place;

typedef struct part_file {
    place at;
    uint64_t number, parts, blocks;
    char header[header_size]; /* without the line of the part */
} part_file;

static FILE *open_at(const place *file)
{
    FILE *in = fopen(file->path, "r");
    if (in == NULL || fseeko(in, (off_t)file->next, SEEK_SET) != 0)
        cli_fail(CLI_IO, "cannot read the part \"%s\": %s; another process may have changed it", file->path,
                 strerror(errno));
    return in;
}

/* Reads the header, up to and including the first line that does not start with "#". */
static void read_header(part_file *file)
{
    FILE *in = open_at(&file->at);
    size_t used = 0;
    const char *line = "#";
    while (line[0] == '#') {
        line = file->header + used;
        const bool more = fgets(file->header + used, (int)(header_size - used), in) != NULL;
        used += more ? strlen(line) : 0;
        if (!more || line == file->header + used || file->header[used - 1] != '\n')
            cli_fail(CLI_IO,
                     "--join: \"%s\" is not a part of a sweep: its header should be whole lines of fewer than %d bytes "
                     "in all",
                     file->at.path, header_size);
    }
    file->at.next = (long long)used;
    fclose(in);
}

/* Removes the line "# part I of N, K blocks" from a header. */
static bool take_part_line(part_file *f)
{
    static const char start[] = "\n# part ";
    char *line = strstr(f->header, start);
    int read = 0;
    if (line == NULL ||
        sscanf(line + 1, "# part %" SCNu64 " of %" SCNu64 ", %" SCNu64 " blocks%n", &f->number, &f->parts, &f->blocks,
               &read) != 3 ||
        read == 0 || line[1 + read] != '\n' || f->number == 0 || f->number > f->parts || f->parts > most_parts)
        return false;
    memmove(line, line + 1 + read, strlen(line + 1 + read) + 1);
    return true;
}

/* Fails unless the part is complete and of the same sweep as the first one. */
static void look_at_part(part_file *f, const part_file *first)
{
    const char *this, *that;
    read_header(f);
    if (!take_part_line(f))
        cli_fail(CLI_FAILED, "--join: \"%s\" is not a part of a sweep", f->at.path);
    if (strcmp(f->header, first->header) != 0) {
        const int width = different_line(f->header, first->header, &this, &that);
        cli_fail(CLI_FAILED, "--join: \"%s\" is of another sweep: it has \"%.*s\" where \"%s\" has \"%.*s\"",
                 f->at.path, width, this, first->at.path, (int)strcspn(that, "\n"), that);
    }
    if (f->parts != first->parts || f->blocks != first->blocks)
        cli_fail(CLI_FAILED,
                 "--join: \"%s\" is one of %" PRIu64 " parts with %" PRIu64 " blocks, \"%s\" one of %" PRIu64
                 " with %" PRIu64,
                 f->at.path, f->parts, f->blocks, first->at.path, first->parts, first->blocks);
}

/* Fails with the numbers of the first few missing parts, if any are missing. */
static void check_missing(const place *all, uint64_t parts)
{
    char names[100] = "";
    uint64_t missing = 0;
    for (uint64_t i = 0; i < parts; i++) {
        if (all[i].path != NULL)
            continue;
        if (missing < 5)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%" PRIu64, missing > 0 ? ", " : "", i + 1);
        missing++;
    }
    if (missing > 0)
        cli_fail(CLI_FAILED, "--join: %" PRIu64 " of %" PRIu64 " parts are missing: %s%s", missing, parts, names,
                 missing > 5 ? ", ..." : "");
}

/* The output must not replace a part, under any name. */
static void check_no_part_is_replaced(const char *const *paths, size_t count)
{
    struct stat output, read;
    if (cli_output_path() == NULL || stat(cli_output_path(), &output) != 0)
        return;
    for (size_t i = 0; i < count; i++)
        if (stat(paths[i], &read) == 0 && read.st_dev == output.st_dev && read.st_ino == output.st_ino)
            cli_fail(CLI_USAGE, "--output: \"%s\" is one of the parts to join; it should be another file",
                     cli_output_path());
}

static void join(const char *const *paths, size_t count)
{
    static part_file first, file;
    place *all = NULL;
    for (size_t i = 0; i < count; i++) {
        part_file *const f = i == 0 ? &first : &file;
        *f = (part_file){.at = {.path = paths[i]}};
        look_at_part(f, &first);
        if (i == 0)
            all = calloc(first.parts, sizeof *all);
        if (all == NULL)
            cli_fail(CLI_FAILED, "out of memory");
        place *const p = &all[f->number - 1];
        if (p->path != NULL)
            cli_fail(CLI_FAILED, "--join: \"%s\" is part %" PRIu64 ", and so is \"%s\"", f->at.path, f->number,
                     p->path);
        *p = f->at;
        if (!is_complete(open_at(p), f->number, f->parts, f->blocks))
            cli_fail(CLI_FAILED, "--join: \"%s\" is incomplete or damaged; run this part again", f->at.path);
    }
    check_missing(all, first.parts);
    cli_table *table = cli_open_output();
    write_text(table, first.header, strlen(first.header));
    for (uint64_t block = 0; block < first.blocks; block++) {
        place *const p = &all[block % first.parts];
        FILE *in = open_at(p);
        if (!copy_block(in, block, table))
            cli_fail(CLI_FAILED, "--join: \"%s\" has changed", p->path);
        p->next = ftello(in);
        fclose(in);
    }
    cli_finish();
    free(all);
}

/* ------------------------------------------------------------------------------------------------------------- jobs */

/* Writes the rows directly to the output, without parts. */
static void stream(const grid *g)
{
    char header[header_size];
    print_header(header, sizeof header, g, 0, 0);
    cli_table *table = cli_open_output();
    write_text(table, header, strlen(header));
    do_blocks(table, g, 0, 1, false, -1);
    cli_finish();
}

/* The files of the parts, next to the output. Their number does not depend on the number of jobs, so a sweep can be
   continued with more or fewer jobs. */
static const char **part_paths(const grid *g, uint64_t parts)
{
    const size_t size = strlen(cli_output_path()) + 50;
    const char **paths = calloc(parts, sizeof *paths);
    char *text = malloc(parts * size), header[header_size];
    if (paths == NULL || text == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    for (uint64_t i = 0; i < parts; i++) {
        paths[i] = text + i * size;
        snprintf(text + i * size, size, "%s.%" PRIu64 "-of-%" PRIu64, cli_output_path(), i + 1, parts);
        print_header(header, sizeof header, g, i + 1, parts);
        check_part(paths[i], header);
    }
    return paths;
}

static void start_jobs(const grid *g, const char *const *paths, uint64_t parts, const int ends[2])
{
    for (uint64_t job = 0; job < jobs; job++) {
        const pid_t child = fork();
        if (child < 0)
            cli_fail(CLI_FAILED, "cannot start a process: %s", strerror(errno));
        if (child == 0) {
            close(ends[0]); /* writing then fails as soon as the first process has ended */
            for (uint64_t i = job; i < parts; i += jobs)
                do_part(g, paths[i], i + 1, parts, ends[1]);
            exit(0);
        }
    }
}

/* Shows the progress until all writing processes have ended. */
static void show_progress(const grid *g, int done)
{
    char bytes[4096];
    uint64_t count = 0;
    for (;;) {
        const ssize_t some = read(done, bytes, sizeof bytes);
        if (some == 0)
            return;
        if (some < 0 && errno != EINTR)
            cli_fail(CLI_FAILED, "cannot wait for the other processes: %s", strerror(errno));
        count += some > 0 ? (uint64_t)some : 0;
        cli_progress((double)count / (double)g->blocks);
    }
}

static void wait_for_jobs(void)
{
    int status, worst = 0;
    while (wait(&status) > 0)
        if (worst == 0 && status != 0)
            worst = WIFEXITED(status) ? WEXITSTATUS(status) : CLI_FAILED;
    if (worst != 0)
        cli_fail((cli_status)worst, "the sweep is incomplete; the same command continues it");
}

/* Reports problems with the output before the work starts, not after. */
static void check_output(void)
{
    const char *path = cli_output_path();
    struct stat status;
    if (path == NULL)
        cli_fail(CLI_USAGE, "--jobs: requires --output, because results are stored next to that file");
    const bool good = stat(path, &status) == 0 ? S_ISREG(status.st_mode) && access(path, W_OK) == 0
                                               : lstat(path, &status) != 0; /* not a dangling link */
    if (!good)
        cli_fail(CLI_IO,
                 "--output: cannot write \"%s\"; with --jobs it should be a file that can be created or replaced",
                 path);
}

static void run_jobs(const grid *g)
{
    check_output();
    const uint64_t parts = g->blocks < most_jobs ? g->blocks : most_jobs;
    const char **paths = part_paths(g, parts);
    int ends[2];
    if (pipe(ends) != 0)
        cli_fail(CLI_FAILED, "out of memory");
    start_jobs(g, paths, parts, ends);
    close(ends[1]);
    show_progress(g, ends[0]);
    wait_for_jobs();
    join(paths, parts);
    for (uint64_t i = 0; i < parts; i++)
        unlink(paths[i]);
    free((char *)paths[0]);
    free(paths);
}

int main(int argc, char **argv)
{
    for (int i = 0; i <= preset_kinds; i++)
        scenes[i] = sweep_scene_name(i);
    cli_parse(&program, argc, argv);
    if (list) {
        list_parameters();
        return 0;
    }
    if (joined.count > 0) {
        if (over.count + methods.count + measures.count + part.count + jobs > 0 || cli_given(&scene))
            cli_fail(
                CLI_USAGE,
                "--join: cannot be combined with options other than --output, because the parts contain the sweep");
        check_no_part_is_replaced(joined.word, joined.count);
        join(joined.word, joined.count);
        return 0;
    }
    grid g;
    make_grid(&g);
    if (part.count > 0 && jobs > 0)
        cli_fail(CLI_USAGE, "--part: cannot be combined with --jobs");
    if (part.count > 0)
        do_one_part(&g);
    else if (jobs > 0)
        run_jobs(&g);
    else
        stream(&g);
    grid_clear(&g);
    return 0;
}
