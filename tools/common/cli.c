/* SPDX-License-Identifier: MIT */
/*
 * What the command-line tools share: see cli.h.
 *
 * Options are read here and not by getopt_long(), which accepts abbreviations of long options and cannot be told not
 * to: a script that says --step would change its meaning with the next option that begins so.
 */
#define _XOPEN_SOURCE 700 /* POSIX 2008 with realpath() */
#include "common/cli.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

struct cli_table {
    FILE *stream;
    const char *option;       /* that names the file */
    const char *name;         /* as it was given */
    char path[PATH_MAX];      /* what the file will be called */
    char temporary[PATH_MAX]; /* what it is called until then; empty: it is written directly */
    bool stamped;
};

/* One tool is one process: what it was asked and what it has open. The signal handler needs the tables. */
static const cli_program *program;
static const char *output_path;
static char *command; /* for the stamp: the options as they were understood */
static cli_table tables[4];
static time_t started;
static size_t table_count;
static bool progress_shown;

/* ---------------------------------------------------------------------------------------------------- messages */

static void erase_progress(void)
{
    if (progress_shown)
        fprintf(stderr, "\r%*s\r", (int)strlen(program->name) + 10, "");
    progress_shown = false;
}

void cli_progress(double fraction)
{
    static time_t last;
    const time_t now = time(NULL);
    if (now == last)
        return;
    last = now;
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%s: %5.1f %%", program->name, 100 * fraction);
        progress_shown = true;
    }
}

static void print_message(const char *format, va_list arguments)
{
    erase_progress();
    fprintf(stderr, "%s: ", program->name);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

_Noreturn void cli_fail(cli_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_message(format, arguments);
    va_end(arguments);
    exit((int)status);
}

void cli_warn(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_message(format, arguments);
    va_end(arguments);
}

/* ------------------------------------------------------------------------------------------------------ output */

static void remove_temporaries(void)
{
    for (size_t i = 0; i < table_count; i++)
        if (tables[i].temporary[0] != '\0')
            unlink(tables[i].temporary);
}

static void on_signal(int number)
{
    remove_temporaries();
    signal(number, SIG_DFL);
    raise(number);
}

static void handle_signals(void)
{
    static const int ending[] = {SIGHUP, SIGINT, SIGPIPE, SIGTERM};
    for (size_t i = 0; i < sizeof ending / sizeof ending[0]; i++)
        if (signal(ending[i], on_signal) == SIG_IGN) /* started in the background, or by nohup */
            signal(ending[i], SIG_IGN);
    signal(SIGXFSZ, SIG_IGN); /* a file size limit is a failed write, with its message */
}

/* A standard stream that the caller has closed would lend its number to the next file that is opened, and messages
   would end up among the data. Opened for reading alone, it cannot be written either. */
static void occupy_standard_streams(void)
{
    int fd;
    do
        fd = open("/dev/null", O_RDONLY);
    while (fd >= 0 && fd <= STDERR_FILENO);
    close(fd);
}

static _Noreturn void fail_to_write(const cli_table *table)
{
    if (table->stream == stdout)
        cli_fail(CLI_IO, "cannot write standard output: %s", strerror(errno));
    cli_fail(CLI_IO, "--%s: cannot write \"%s\": %s; it should be a file that can be created or replaced",
             table->option, table->name, strerror(errno));
}

static _Noreturn void fail_as_taken(const cli_table *table)
{
    cli_fail(CLI_USAGE, "--%s: \"%s\" is written already; it should be another file", table->option, table->name);
}

static void close_stream(const cli_table *table)
{
    if (ferror(table->stream) != 0 || fflush(table->stream) != 0 || fclose(table->stream) != 0)
        fail_to_write(table);
}

/* Open a file of another name beside it, so that a rename can put it in place at once. It is the same name for the same
   file, and of no other process: in a container the numbers of processes come again. */
static void open_temporary(cli_table *table)
{
    char name[PATH_MAX];
    errno = ENAMETOOLONG;
    if (snprintf(name, PATH_MAX, "%s.%lld-%ld.part", table->path, (long long)started, (long)getpid()) < PATH_MAX)
        table->stream = fopen(name, "wx");
    if (table->stream != NULL)
        strcpy(table->temporary, name);
    else if (errno == EEXIST)
        fail_as_taken(table);
}

static void open_stream(cli_table *table)
{
    const char *path = table->name;
    struct stat status;
    const bool exists = stat(path, &status) == 0;
    const bool device = strncmp(path, "/dev/", 5) == 0 && strncmp(path, "/dev/shm/", 9) != 0;
    if (device || (exists && !S_ISREG(status.st_mode))) {
        table->stream = fopen(path, "w"); /* a device, a pipe: there is nothing to put in place */
    } else if (exists) {
        /* a link stays a link to what it points to, a file keeps its mode */
        if (access(path, W_OK) == 0 && realpath(path, table->path) != NULL)
            open_temporary(table);
        if (table->stream != NULL && fchmod(fileno(table->stream), status.st_mode & 0777) != 0)
            fail_to_write(table);
    } else if (errno == ENOENT && lstat(path, &status) != 0) {
        /* a new file, and no link to nowhere; its name fits, or stat() had not said ENOENT */
        strcpy(table->path, path);
        open_temporary(table);
    }
    if (table->stream == NULL)
        fail_to_write(table);
}

cli_table *cli_open_file(const char *option, const char *path)
{
    assert(table_count < sizeof tables / sizeof tables[0]); /* no tool opens more */
    cli_table *table = &tables[table_count++];
    *table = (cli_table){.option = option, .name = path != NULL ? path : "/dev/stdout"};
    if (strcmp(table->name, "/dev/stdout") != 0) {
        open_stream(table);
    } else { /* not opened anew: that would truncate a file behind it */
        for (size_t i = 0; i < table_count; i++)
            if (tables[i].stream == stdout)
                fail_as_taken(table);
        table->stream = stdout;
    }
    return table;
}

cli_table *cli_open_output(void)
{
    return cli_open_file("output", output_path);
}

/* With the first line and not before: a tool may open several tables, and fail at the last. */
static void stamp(cli_table *table)
{
    table->stamped = true;
    cli_comment(table, "springstep %s, %s", spring_version(), program->name);
    cli_comment(table, "command: %s", command);
#if defined(__clang__)
    cli_comment(table, "compiler: clang %d.%d.%d", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
    cli_comment(table, "compiler: gcc %d.%d.%d", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
    cli_comment(table, "compiler: unknown");
#endif
}

static void print_line(cli_table *table, const char *start, const char *format, va_list arguments)
{
    if (table->stream == stdout)
        erase_progress();
    if (!table->stamped)
        stamp(table);
    if (fputs(start, table->stream) == EOF || vfprintf(table->stream, format, arguments) < 0 ||
        fputc('\n', table->stream) == EOF)
        fail_to_write(table);
}

void cli_comment(cli_table *table, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(table, "# ", format, arguments);
    va_end(arguments);
}

void cli_row(cli_table *table, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(table, "", format, arguments);
    va_end(arguments);
}

void cli_columns(cli_table *table, const char *names)
{
    char *line = strdup(names);
    if (line == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    for (char *space = line; (space = strchr(space, ' ')) != NULL;)
        *space = '\t';
    cli_row(table, "%s", line);
    free(line);
}

static void put_in_place(cli_table *table)
{
    if (table->temporary[0] == '\0')
        return;
    if (rename(table->temporary, table->path) != 0)
        fail_to_write(table);
    table->temporary[0] = '\0';
}

void cli_close(cli_table *table)
{
    assert(table == &tables[table_count - 1]);
    close_stream(table);
    put_in_place(table);
    table_count--;
}

void cli_finish(void)
{
    erase_progress();
    for (size_t i = 0; i < table_count; i++)
        close_stream(&tables[i]);
    for (size_t i = 0; i < table_count; i++)
        put_in_place(&tables[i]);
}

/* ------------------------------------------------------------------------------------------------------ numbers */

static bool parse_count(const char *text, uint64_t *value)
{
    if (!isdigit((unsigned char)text[0]))
        return false;
    char *end;
    errno = 0;
    unsigned long long mantissa = strtoull(text, &end, 10);
    const bool power = *end == 'e' && isdigit((unsigned char)end[1]);
    const unsigned long long exponent = power ? strtoull(end + 1, &end, 10) : 0;
    if (errno != 0 || *end != '\0' || exponent > 19)
        return false;
    for (unsigned i = 0; i < exponent; i++) {
        if (mantissa > UINT64_MAX / 10)
            return false;
        mantissa *= 10;
    }
    *value = mantissa;
    return true;
}

/* What follows the number; NULL: there is none. */
static const char *read_real(const char *text, double *value)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    const bool vanished = errno == ERANGE && *value == 0;
    return end != text && !isspace((unsigned char)text[0]) && isfinite(*value) && !vanished ? end : NULL;
}

static bool parse_real(const char *text, double *value)
{
    const char *end = read_real(text, value);
    return end != NULL && *end == '\0';
}

/* `count` of them, separated by commas; changes nothing otherwise. */
static bool parse_reals(const char *text, double *values, size_t count)
{
    double parsed[8];
    assert(count <= sizeof parsed / sizeof parsed[0]); /* no option has more */
    for (size_t i = 0; i < count; i++) {
        const char *end = read_real(text, &parsed[i]);
        if (end == NULL || *end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    memcpy(values, parsed, count * sizeof parsed[0]);
    return true;
}

static bool parse_choice(const char *text, const char *const *choices, int *value)
{
    for (int i = 0; choices[i] != NULL; i++) {
        if (strcmp(text, choices[i]) == 0) {
            *value = i;
            return true;
        }
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------ methods */

bool cli_for_springs(const spring_method_info *method)
{
    return method->springs;
}

bool cli_for_steps(const spring_method_info *method)
{
    return method->springs && method->order > 0;
}

bool cli_for_scenes(const spring_method_info *method)
{
    return method->scenes;
}

static bool parse_method(const char *text, const cli_option *o)
{
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        const spring_method_info *info = spring_method_describe(m);
        if (o->offers(info) && strcmp(text, info->name) == 0) {
            *o->choice = (int)m;
            return true;
        }
    }
    return false;
}

void cli_list_methods(char *text, size_t size, bool (*offers)(const spring_method_info *method))
{
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method_info *info = spring_method_describe(spring_method_at(i));
        if (offers(info) && length < size)
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "", info->name);
    }
}

static void print_methods(FILE *out, const cli_option *o)
{
    char text[200];
    cli_list_methods(text, sizeof text, o->offers);
    fputs(text, out);
}

/* ------------------------------------------------------------------------------------------------------ options */

static const cli_option *find_option(const cli_option *options, const char *name, size_t length)
{
    for (const cli_option *o = options; o->name != NULL; o++)
        if (strlen(o->name) == length && strncmp(o->name, name, length) == 0)
            return o;
    return NULL;
}

static void print_expectation(FILE *out, const cli_option *o)
{
    switch (o->kind) {
    case CLI_FLAG:
        break;
    case CLI_COUNT:
        if (o->most > 0)
            fprintf(out, "a whole number from %" PRIu64 " to %" PRIu64, o->least, o->most);
        else
            fprintf(out, "a whole number of at least %" PRIu64, o->least);
        break;
    case CLI_REAL:
        fputs("a finite number", out);
        break;
    case CLI_NOT_NEGATIVE:
        fputs("a finite number of at least 0", out);
        break;
    case CLI_POSITIVE:
        fputs("a finite number greater than 0", out);
        break;
    case CLI_CHOICE:
        fputs("one of", out);
        for (int i = 0; o->choices[i] != NULL; i++)
            fprintf(out, "%s %s", i > 0 ? "," : "", o->choices[i]);
        break;
    case CLI_METHOD:
        fputs("one of ", out);
        print_methods(out, o);
        break;
    case CLI_REALS:
        fprintf(out, "%" PRIu64 " finite numbers separated by commas, %s", o->least, o->value);
        break;
    case CLI_FILE:
    case CLI_FOLDER:
        fprintf(out, "the name of a %s", o->kind == CLI_FILE ? "file" : "folder");
        break;
    }
}

/* "program: --option: problem what it should be" */
static _Noreturn void fail_at(const cli_option *o, const char *value, const char *problem)
{
    fprintf(stderr, "%s: --%s: ", program->name, o->name);
    if (value != NULL)
        fprintf(stderr, "\"%s\" ", value);
    fputs(problem, stderr);
    print_expectation(stderr, o);
    fputc('\n', stderr);
    exit(CLI_USAGE);
}

static bool store(const cli_option *o, const char *value)
{
    switch (o->kind) {
    case CLI_FLAG:
        break;
    case CLI_COUNT:
        return parse_count(value, o->count) && *o->count >= o->least && (o->most == 0 || *o->count <= o->most);
    case CLI_REAL:
        return parse_real(value, o->real);
    case CLI_NOT_NEGATIVE:
        return parse_real(value, o->real) && *o->real >= 0;
    case CLI_POSITIVE:
        return parse_real(value, o->real) && *o->real > 0;
    case CLI_CHOICE:
        return parse_choice(value, o->choices, o->choice);
    case CLI_METHOD:
        return parse_method(value, o);
    case CLI_REALS:
        return parse_reals(value, o->real, o->least);
    case CLI_FILE:
    case CLI_FOLDER:
        *o->file = value;
        return value[0] != '\0';
    }
    return false;
}

static bool want_help, want_version;

static const cli_option common_options[] = {
    {"output", CLI_FILE, .file = &output_path, .value = "FILE",
     .help = "write to FILE instead of standard output; short: -o FILE.\n"
             "FILE appears, or is replaced, when it is complete"},
    {"help", CLI_FLAG, .flag = &want_help, .help = "print this text and exit"},
    {"version", CLI_FLAG, .flag = &want_version, .help = "print the version and exit"},
    {.name = NULL},
};

static void print_options(const cli_option *options)
{
    enum { column = 26 };
    for (const cli_option *o = options; o->name != NULL; o++) {
        int width = printf("  --%s%s%s", o->name, o->value != NULL ? " " : "", o->value != NULL ? o->value : "");
        if (o->kind == CLI_METHOD) {
            printf("%*s", column - width, "");
            print_methods(stdout, o);
            putchar('\n');
        }
        for (const char *line = o->help; line != NULL; width = 0) {
            const char *end = strchr(line, '\n');
            printf("%*s%.*s\n", width < column ? column - width : 2, "",
                   end != NULL ? (int)(end - line) : (int)strlen(line), line);
            line = end != NULL ? end + 1 : NULL;
        }
    }
}

static void print_usage(void)
{
    printf("Usage: %s", program->name);
    for (const cli_option *o = program->options; o->name != NULL; o++)
        if (o->required)
            printf(" --%s %s", o->name, o->value);
    printf(" [OPTION]...\n%s\n\n", program->summary);
    print_options(program->options);
    print_options(common_options);
    printf("\n%s\n\n"
           "Numbers are decimal (1e-4) or hexadecimal (0x1p-13); whole numbers may be written 1e7. Of an\n"
           "option given several times the last one counts. The output is tab-separated values: lines that\n"
           "start with \"#\" say how they were made, then come the names of the columns, then the rows.\n\n"
           "Exit status: 0 done, 1 the computation failed or a check did not hold, 2 bad usage, 3 cannot read\n"
           "or write.\n",
           program->details);
}

static const cli_option *option_of(const char *word, const char **value)
{
    *value = NULL;
    if (word[0] == '-' && word[1] == 'o' && strncmp(word, "-output", 7) != 0) { /* one dash typed for two */
        if (word[2] != '\0')
            *value = word + 2;
        return &common_options[0];
    }
    if (word[0] != '-' || word[1] != '-')
        return NULL;
    const size_t length = strcspn(word + 2, "=");
    if (word[2 + length] == '=')
        *value = word + 2 + length + 1;
    const cli_option *o = find_option(program->options, word + 2, length);
    return o != NULL ? o : find_option(common_options, word + 2, length);
}

/* Where the output goes is no part of how it was made: it is not stamped, and of other files only that there are. */
static void record(FILE *words, const cli_option *o, const char *value)
{
    if (o == &common_options[0])
        return;
    fprintf(words, " --%s", o->name);
    if (o->kind != CLI_FLAG)
        fprintf(words, " %s", o->kind == CLI_FILE || o->kind == CLI_FOLDER ? o->value : value);
}

static void print_and_exit_if_wanted(void)
{
    if (!want_help && !want_version)
        return;
    if (want_help)
        print_usage();
    else
        printf("%s (springstep) %s\n", program->name, spring_version());
    close_stream(&(cli_table){.stream = stdout});
    exit(0);
}

void cli_parse(const cli_program *p, int argc, char **argv)
{
    program = p;
    started = time(NULL);
    occupy_standard_streams();
    handle_signals();
    atexit(remove_temporaries);
    uint64_t given = 0; /* bit i: option i of the table */
    size_t length;
    FILE *words = open_memstream(&command, &length);
    if (words == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    fputs(program->name, words);
    for (int i = 1; i < argc; i++) {
        const char *value;
        const cli_option *o = option_of(argv[i], &value);
        if (o == NULL)
            cli_fail(CLI_USAGE, "\"%s\" is not an option; see %s --help", argv[i], program->name);
        if (o->kind == CLI_FLAG) {
            if (value != NULL)
                cli_fail(CLI_USAGE, "--%s: \"%s\" is not expected: this option takes no value", o->name, value);
            *o->flag = true;
            print_and_exit_if_wanted();
        } else {
            if (value == NULL && i + 1 < argc)
                value = argv[++i];
            if (value == NULL)
                fail_at(o, NULL, "the value is missing; it should be ");
            if (!store(o, value))
                fail_at(o, value, "is not ");
        }
        record(words, o, value);
        for (int k = 0; program->options[k].name != NULL; k++)
            if (o == &program->options[k])
                given |= UINT64_C(1) << k;
    }
    if (fclose(words) != 0)
        cli_fail(CLI_FAILED, "out of memory");
    for (int k = 0; program->options[k].name != NULL; k++)
        if (program->options[k].required && (given >> k & 1) == 0)
            fail_at(&program->options[k], NULL, "is missing; it should be ");
}
