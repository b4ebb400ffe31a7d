/* SPDX-License-Identifier: MIT */
/*
 * The common code of the command-line tools: options from a table, strict numbers, help, tables of results, progress,
 * exit statuses. cli.c reads the command line, cli_help.c prints the help, cli_output.c writes tables and messages.
 *
 * A tool calls cli_parse() once, opens its tables, writes rows, and ends with cli_finish(). Every error calls
 * cli_fail(), which prints a message, sets the exit status and leaves no half-written file.
 */
#ifndef SPRINGSTEP_CLI_H
#define SPRINGSTEP_CLI_H

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

/* Times n*dt are exact up to this number of steps. A macro, because tables of options need a constant. */
#define CLI_MOST_STEPS (UINT64_C(1) << 53)

typedef enum cli_status {
    CLI_FAILED = 1, /* the computation failed, or a check did not hold */
    CLI_USAGE = 2,  /* bad usage */
    CLI_IO = 3      /* cannot read or write */
} cli_status;

typedef enum cli_kind {
    CLI_FLAG,         /* takes no value */
    CLI_COUNT,        /* a whole number: 10000000 or 1e7 */
    CLI_REAL,         /* a finite number */
    CLI_NOT_NEGATIVE, /* a finite number >= 0 */
    CLI_POSITIVE,     /* a finite number > 0 */
    CLI_REALS,        /* `least` finite numbers, separated by commas; see `times` */
    CLI_CHOICE,       /* one of a list of words */
    CLI_METHOD,       /* the name of a method that the tool offers */
    CLI_FILE,         /* the name of a file to write */
    CLI_INPUT,        /* the name of a file to read; the stamp contains it, unlike the names of output files */
    CLI_FOLDER,       /* the name of a folder to write to */
    CLI_WORDS         /* all words up to the next option; words of repeated options are appended */
} cli_kind;

typedef struct cli_words {
    const char **word; /* [count] */
    size_t count;
} cli_words;

/* One row of a tool's table of options, from which --help, the man page and shell completion are generated. The target
   of the pointer initially holds the default. --help prints it if it is a valid value of the option; a choice of -1
   means that there is no default. If an option is repeated, the last value is used, unless the option has `times`. */
typedef struct cli_option {
    const char *name; /* without the dashes; NULL ends the table */
    cli_kind kind;
    union {
        bool *flag;
        uint64_t *count;
        double *real; /* CLI_REALS: the first of an array */
        int *choice;  /* index into choices; CLI_METHOD: a spring_method */
        const char **file;
        cli_words *words;
    };
    const char *value;          /* name of the value in --help */
    const char *help;           /* --help prints the first line, the man page all; NULL: the words suffice */
    const char *const *choices; /* CLI_CHOICE: ended by NULL */
    bool (*offers)(const spring_method_info *method); /* CLI_METHOD */
    uint64_t least, most; /* CLI_COUNT: limits; most = 0 is no limit. CLI_REALS: `least` is the count */
    uint64_t *times;      /* CLI_REALS: number of repetitions, at most `most`; their values follow each other */
    bool required;
    const void *needs; /* target of another option, without which this one has no effect */
    bool unstamped;    /* does not affect the rows */
} cli_option;

typedef struct cli_program {
    const char *name;
    const char *summary;       /* one line */
    const char *details;       /* description in the man page; an empty line ends a paragraph */
    const cli_option *options; /* besides --output, --help and --version, which every tool has */
    const char *columns;       /* of the default table, separated by spaces */
    const char *meaning;       /* of the columns, in the man page; format as `details` */
    const char *shown[2];      /* columns of an example chart, x and y */
    const char *examples[3];   /* the options of three short runs */
    bool stamps_itself;        /* the tool writes the stamp of its tables itself */
} cli_program;

/* Filters for `offers`: methods for one spring, step methods for one spring, methods for scenes. */
bool cli_for_springs(const spring_method_info *method);
bool cli_for_steps(const spring_method_info *method);
bool cli_for_scenes(const spring_method_info *method);

/** Writes the names of the offered methods, separated by commas. */
void cli_list_methods(char *text, size_t size, bool (*offers)(const spring_method_info *method));

/** Read the command line. Prints --help or --version and exits; exits with CLI_USAGE if anything is wrong. */
void cli_parse(const cli_program *program, int argc, char **argv);

/** Returns true if the option with this target was given. */
bool cli_given(const void *target);

#if defined(__GNUC__)
#define CLI_PRINTF(which) __attribute__((format(printf, which, which + 1)))
#else
#define CLI_PRINTF(which)
#endif

/** Print "program: message", remove unfinished files, and exit. */
_Noreturn void cli_fail(cli_status status, const char *format, ...) CLI_PRINTF(2);

/** Print "program: message". */
void cli_warn(const char *format, ...) CLI_PRINTF(1);

/* A table of tab-separated values with a stamp: tool, version, command line and compiler, in lines that start with "#".
   The bytes depend on nothing else, so two runs give the same file. */
typedef struct cli_table cli_table;

/** The value of --output as given; NULL: standard output. */
const char *cli_output_path(void);

/** The parsed options as in the stamp: on one line, quoted for a shell. */
const char *cli_stamped_command(void);

/** Open the main table, in the file of --output or on standard output. */
cli_table *cli_open_output(void);

/** The same, without the stamp. */
cli_table *cli_open_bare_output(void);

/**
 * Open a further table, in the file that an option names; NULL: standard output.
 *
 * Rows go to a temporary file in the same directory, which cli_finish() renames to the requested name. So an older file
 * survives a failure, and a file with that name is always complete. Devices and pipes are written directly.
 */
cli_table *cli_open_file(const char *option, const char *path);

void cli_comment(cli_table *table, const char *format, ...) CLI_PRINTF(2); /* one line, "# " is added */
void cli_columns(cli_table *table, const char *names);                     /* separated by spaces */
void cli_row(cli_table *table, const char *format, ...) CLI_PRINTF(2);     /* one line, "\n" is added */

/** Writes bytes instead of rows, without a stamp. */
void cli_bytes(cli_table *table, const void *bytes, size_t count);

/** Close the table that was opened last and rename its file now. */
void cli_close(cli_table *table);

/** Close every table and rename the files. */
void cli_finish(void);

/** Show the progress on a terminal. Each call reads the clock. */
void cli_progress(double fraction);

#endif
