/* SPDX-License-Identifier: MIT */
/* Messages, progress and tables of the tools; see cli.h. */
#define _XOPEN_SOURCE 700 /* POSIX 2008 with realpath() */
#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "common/cli_parts.h"

struct cli_table {
    FILE *stream;
    const char *option;       /* the option that names the file */
    const char *name;         /* as given */
    char path[PATH_MAX];      /* final name of the file */
    char temporary[PATH_MAX]; /* its name until then; empty: written directly */
    bool stamped;
};

/* Static, because the signal handler needs them. */
static cli_table tables[4];
static size_t table_count;
static bool progress_shown;

/* ---------------------------------------------------------------------------------------------------- messages */

enum { PROGRESS_WIDTH = 64 };

static void erase_progress(void)
{
    if (progress_shown)
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH, "");
    progress_shown = false;
}

void cli_describe_time_left(char *text, size_t size, double fraction, double spent)
{
    const double left = spent * (1 - fraction) / fraction, minute = 60, hour = 3600; /* [s] */
    text[0] = '\0';
    if (spent < 2)
        return;
    if (left < 100)
        snprintf(text, size, ", %.0f s left", left);
    else if (left < 100 * minute)
        snprintf(text, size, ", %.0f min left", left / minute);
    else if (left < 1000 * hour)
        snprintf(text, size, ", %.0f h left", left / hour);
}

void cli_progress(double fraction)
{
    static time_t last;
    const time_t now = time(NULL);
    if (now == last)
        return;
    last = now;
    if (!isatty(STDERR_FILENO))
        return;
    char line[PROGRESS_WIDTH + 1], left[32];
    cli_describe_time_left(left, sizeof left, fraction, difftime(now, cli_asked.started));
    snprintf(line, sizeof line, "%s: %5.1f %%%s", cli_asked.program->name, 100 * fraction, left);
    fprintf(stderr, "\r%-*s", PROGRESS_WIDTH, line);
    progress_shown = true;
}

static void print_message(const char *format, va_list arguments)
{
    erase_progress();
    fprintf(stderr, "%s: ", cli_asked.program->name);
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

/* All signals are blocked while this runs. At the end only `number` is unblocked, and it terminates the process. */
static void on_signal(int number)
{
    remove_temporaries();
    sigset_t own;
    sigemptyset(&own);
    sigaddset(&own, number);
    signal(number, SIG_DFL);
    raise(number);
    sigprocmask(SIG_UNBLOCK, &own, NULL);
}

static void handle_signals(void)
{
    static const int ending[] = {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGALRM, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU};
    struct sigaction handled = {.sa_handler = on_signal}, before;
    sigfillset(&handled.sa_mask);
    /* a signal that is ignored at the start stays ignored: the program runs in the background, or under nohup */
    for (size_t i = 0; i < sizeof ending / sizeof ending[0]; i++)
        if (sigaction(ending[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(ending[i], &handled, NULL);
    signal(SIGXFSZ, SIG_IGN); /* a write past the file size limit then fails with a message */
}

/* If the caller has closed a standard stream, the next file that is opened would get its descriptor, and messages would
   end up in the data. So closed streams are opened for reading, which makes writing to them fail. */
static void occupy_standard_streams(void)
{
    int fd;
    do
        fd = open("/dev/null", O_RDONLY);
    while (fd >= 0 && fd <= STDERR_FILENO);
    close(fd);
}

void cli_guard_files(void)
{
    occupy_standard_streams();
    handle_signals();
    atexit(remove_temporaries);
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

/* Opens a temporary file in the same directory, so that rename() replaces the target atomically. The name contains the
   start time as well as the process number, because process numbers repeat in containers. */
static void open_temporary(cli_table *table)
{
    char name[PATH_MAX];
    if (snprintf(name, PATH_MAX, "%s.%lld-%ld.part", table->path, (long long)cli_asked.started, (long)getpid()) >=
        PATH_MAX) {
        errno = ENAMETOOLONG;
        return;
    }
    sigset_t all, before; /* no signal may come between the file and its entry in the table */
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    table->stream = fopen(name, "wx");
    if (table->stream != NULL)
        strcpy(table->temporary, name);
    const int reason = errno;
    sigprocmask(SIG_SETMASK, &before, NULL);
    if (table->stream == NULL && reason == EEXIST)
        fail_as_taken(table);
    errno = reason;
}

/* The descriptor that such a name stands for, or -1. Opening the name again would truncate a file. */
static int descriptor_of(const char *path)
{
    int number = -1, end = 0;
    if (sscanf(path, "/dev/fd/%d%n", &number, &end) == 1 || sscanf(path, "/proc/self/fd/%d%n", &number, &end) == 1)
        return path[end] == '\0' ? number : -1;
    return strcmp(path, "/dev/stdout") == 0 ? STDOUT_FILENO : strcmp(path, "/dev/stderr") == 0 ? STDERR_FILENO : -1;
}

static void open_stream(cli_table *table)
{
    const char *path = table->name;
    if (descriptor_of(path) >= 0) {
        const int copy = dup(descriptor_of(path));
        table->stream = copy >= 0 ? fdopen(copy, "w") : NULL;
        if (table->stream == NULL)
            fail_to_write(table);
        return;
    }
    struct stat status;
    const bool exists = stat(path, &status) == 0;
    const bool device = strncmp(path, "/dev/", 5) == 0 && strncmp(path, "/dev/shm/", 9) != 0;
    if (device || (exists && !S_ISREG(status.st_mode))) {
        table->stream = fopen(path, "w"); /* a device or a pipe is not replaced */
    } else if (exists) {
        /* a symbolic link is kept and its target replaced; the file keeps its mode */
        if (access(path, W_OK) == 0 && realpath(path, table->path) != NULL)
            open_temporary(table);
        if (table->stream != NULL && fchmod(fileno(table->stream), status.st_mode & 0777) != 0)
            fail_to_write(table);
    } else if (errno == ENOENT && lstat(path, &status) != 0) {
        /* a new file, not a dangling link; its name fits into the path, or stat() would have failed differently */
        strcpy(table->path, path);
        open_temporary(table);
    }
    if (table->stream == NULL)
        fail_to_write(table);
}

cli_table *cli_open_file(const char *option, const char *path)
{
    assert(table_count < sizeof tables / sizeof tables[0]); /* no tool opens more tables */
    cli_table *table = &tables[table_count++];
    *table = (cli_table){.option = option, .name = path != NULL ? path : "/dev/stdout"};
    if (descriptor_of(table->name) != STDOUT_FILENO) {
        open_stream(table);
    } else { /* not opened again: that would truncate a file to which it is redirected */
        for (size_t i = 0; i < table_count; i++)
            if (tables[i].stream == stdout)
                fail_as_taken(table);
        table->stream = stdout;
    }
    return table;
}

const char *cli_output_path(void)
{
    return cli_asked.output;
}

const char *cli_stamped_command(void)
{
    return cli_asked.text;
}

cli_table *cli_open_output(void)
{
    return cli_open_file("output", cli_asked.output);
}

cli_table *cli_open_bare_output(void)
{
    cli_table *table = cli_open_output();
    table->stamped = true;
    return table;
}

/* Called with the first line, not on opening: a tool may open several tables, and fail at the last. */
static void stamp(cli_table *table)
{
    table->stamped = true;
    cli_comment(table, "springstep %s, %s", spring_version(), cli_asked.program->name);
    cli_comment(table, "command: %s", cli_asked.text);
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
    if (!table->stamped && !cli_asked.program->stamps_itself)
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

void cli_bytes(cli_table *table, const void *bytes, size_t count)
{
    if (fwrite(bytes, 1, count, table->stream) != count)
        fail_to_write(table);
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

_Noreturn void cli_finish_text(void)
{
    close_stream(&(cli_table){.stream = stdout});
    exit(0);
}
