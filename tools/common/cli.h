/* SPDX-License-Identifier: MIT */
/*
 * What the command-line tools share: options from a table, strict numbers, help, tables of results, progress, exit
 * statuses. cli.c reads the command line, cli_help.c says what it can be, cli_output.c writes.
 *
 * A tool calls cli_parse() once, opens its tables, writes rows, and ends with cli_finish(). Whatever goes wrong on the
 * way ends in cli_fail(): a message on standard error, an exit status, and no half-written file.
 */
#ifndef SPRINGSTEP_CLI_H
#define SPRINGSTEP_CLI_H

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <springstep/spring.h>

#define CLI_MOST_STEPS (UINT64_C(1) << 53) /* up to there times are exact; a constant for the rows of options */

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
    CLI_REALS,        /* as many finite numbers as `least` says, separated by commas; see `times` */
    CLI_CHOICE,       /* one of a list of words */
    CLI_METHOD,       /* the name of a method that the tool offers */
    CLI_FILE,         /* the name of a file to write */
    CLI_INPUT,        /* the name of a file to read: it is stamped, the others are not */
    CLI_FOLDER,       /* the name of a folder to write to */
    CLI_WORDS         /* all words up to the next option; given several times, they add up */
} cli_kind;

typedef struct cli_words {
    const char **word; /* [count] */
    size_t count;
} cli_words;

/* One row of a tool's table of options, from which --help, the man page and the completion of a shell are made. What
   the pointer points to holds the default, and --help says so, if it is a value that the option could have; choice: -1
   is none. Of an option that is given several times the last one counts, unless it has `times`. */
typedef struct cli_option {
    const char *name; /* without the dashes; NULL ends the table */
    cli_kind kind;
    union {
        bool *flag;
        uint64_t *count;
        double *real; /* CLI_REALS: the first of them */
        int *choice;  /* index into choices; CLI_METHOD: a spring_method */
        const char **file;
        cli_words *words;
    };
    const char *value;          /* what --help calls the value */
    const char *help;           /* the first line is in --help, all of them in the man page; NULL: the words say it */
    const char *const *choices; /* CLI_CHOICE: ended by NULL */
    bool (*offers)(const spring_method_info *method); /* CLI_METHOD */
    uint64_t least, most; /* CLI_COUNT: limits; most = 0 is no limit. CLI_REALS: least = how many */
    uint64_t *times;      /* CLI_REALS: how often it is given, at most `most` times, one set behind the other */
    bool required;
    const void *needs; /* the target of the option without which this one has no effect */
    bool unstamped;    /* says nothing of what the rows are */
} cli_option;

typedef struct cli_program {
    const char *name;
    const char *summary;       /* one line */
    const char *details;       /* for the man page: what there is to know; an empty line ends a paragraph */
    const cli_option *options; /* besides --output, --help and --version, which every tool has */
    const char *columns;       /* of the table that it writes if not told otherwise, separated by spaces */
    const char *meaning;       /* for the man page: what is in the columns; like `details` */
    const char *shown[2];      /* columns that make a chart, x and y */
    const char *examples[3];   /* the options of three runs that take no long time */
    bool stamps_itself;        /* its tables start with the rows that it writes */
} cli_program;

/* What tools offer: methods for one spring, those of them that take steps, methods for scenes. */
bool cli_for_springs(const spring_method_info *method);
bool cli_for_steps(const spring_method_info *method);
bool cli_for_scenes(const spring_method_info *method);

/** Their names, separated by commas. */
void cli_list_methods(char *text, size_t size, bool (*offers)(const spring_method_info *method));

/** Read the command line. Prints --help or --version and exits; exits with CLI_USAGE if anything is wrong. */
void cli_parse(const cli_program *program, int argc, char **argv);

/** Was the option given that stores its value there? */
bool cli_given(const void *target);

#if defined(__GNUC__)
#define CLI_PRINTF(which) __attribute__((format(printf, which, which + 1)))
#else
#define CLI_PRINTF(which)
#endif

/** Print "program: message", remove the files that are not finished, and exit. */
_Noreturn void cli_fail(cli_status status, const char *format, ...) CLI_PRINTF(2);

/** Print "program: message". */
void cli_warn(const char *format, ...) CLI_PRINTF(1);

/* A table of tab-separated values with its stamp: tool, version, command line and compiler, in lines that start with
   "#". The bytes depend on nothing else, so two runs give the same file. */
typedef struct cli_table cli_table;

/** The file of --output, as it was given; NULL: standard output. */
const char *cli_output_path(void);

/** The options as they were understood, as they stand in the stamp: on one line, quoted for a shell. */
const char *cli_stamped_command(void);

/** Open the table for the rows: the file of --output, or standard output. */
cli_table *cli_open_output(void);

/** The same without the lines that start with "#". */
cli_table *cli_open_bare_output(void);

/**
 * Open a further table, in the file that an option names; NULL: standard output.
 *
 * The rows go to a temporary file next to the requested one, which takes its name in cli_finish() and not
 * before: an older file survives a failure, and a file under that name is complete. Devices and pipes are written
 * directly.
 */
cli_table *cli_open_file(const char *option, const char *path);

void cli_comment(cli_table *table, const char *format, ...) CLI_PRINTF(2); /* one line, "# " is added */
void cli_columns(cli_table *table, const char *names);                     /* separated by spaces */
void cli_row(cli_table *table, const char *format, ...) CLI_PRINTF(2);     /* one line, "\n" is added */

/** Close the table that was opened last and give its file its name now. */
void cli_close(cli_table *table);

/** Close every table and give the files their names. */
void cli_finish(void);

/** Show on a terminal how much is done; costs a look at the clock per call. */
void cli_progress(double fraction);

#endif
