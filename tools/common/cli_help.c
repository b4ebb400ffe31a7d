/* SPDX-License-Identifier: MIT */
/* --help, the man page and shell completion of a tool, generated from its table of options; see cli.h. */
#include <ctype.h>
#include <stdarg.h>
#include <string.h>

#include "common/cli_parts.h"

enum { EXAMPLES = sizeof(((cli_program *)0)->examples) / sizeof(char *) };

/* The length of the first line of a text. */
static int line_length(const char *text)
{
    return (int)strcspn(text, "\n");
}

/* ---------------------------------------------------------------------------------------------------------- help */

/* " M" in "--method M" */
static const char *space_before(const char *value)
{
    return value != NULL ? " " : "";
}

static const char *or_nothing(const char *text)
{
    return text != NULL ? text : "";
}

static void print_option(size_t i)
{
    enum { column = 26 };
    const cli_option *o = cli_option_at(i);
    const bool output = strcmp(o->name, "output") == 0;
    const int width =
        printf("  %s--%s%s%s", output ? "-o, " : "", o->name, space_before(o->value), or_nothing(o->value));
    printf("%*s", width < column ? column - width : 2, "");
    if (o->help != NULL)
        printf("%.*s", line_length(o->help), o->help);
    else
        fputs(cli_word_list(o, ", "), stdout);
    if (cli_default(i)[0] != '\0')
        printf(" (default: %s)", cli_default(i));
    putchar('\n');
}

/* The number of a column, for awk, which has no column names. */
static int column_number(const char *columns, const char *name)
{
    int number = 1;
    for (const char *c = columns; *c != '\0'; number++) {
        const size_t length = strcspn(c, " ");
        if (strlen(name) == length && strncmp(c, name, length) == 0)
            break;
        c += length + (c[length] == ' ');
    }
    return number;
}

/* Prints words in lines, the first line after "Columns:". */
static void print_columns(const char *words)
{
    enum { right = 98 };
    int at = printf("Columns:");
    for (const char *w = words; *w != '\0';) {
        const int length = (int)strcspn(w, " ");
        if (at + 1 + length > right)
            at = printf("\n ") - 1;
        at += printf(" %.*s", length, w);
        w += length;
        w += *w == ' ';
    }
    putchar('\n');
}

static void print_readers(const cli_program *p)
{
    const char *x = p->shown[0], *y = p->shown[1];
    printf("Read FILE in gnuplot: set datafile separator tab; plot \"FILE\" using \"%s\":\"%s\"\n"
           "  in awk: awk -F'\\t' '!/^#/ {print $%d, $%d}' FILE  in pandas: read_csv(\"FILE\", sep=\"\\t\", "
           "comment=\"#\")\n",
           x, y, column_number(p->columns, x), column_number(p->columns, y));
}

void cli_print_help(void)
{
    const cli_program *p = cli_asked.program;
    printf("Usage: %s", p->name);
    for (const cli_option *o = p->options; o->name != NULL; o++)
        if (o->required)
            printf(" --%s %s", o->name, o->value);
    printf(" [OPTION]...\n%s\n\n", p->summary);
    size_t i = 0;
    for (; strcmp(cli_option_at(i)->name, "help") != 0; i++)
        print_option(i);
    printf("  -h, --help, --version   print this or the version; manual: %s --man | man -l -\n", p->name);
    if (p->columns != NULL) {
        putchar('\n');
        print_columns(p->columns);
    }
    for (i = 0; i < EXAMPLES && p->examples[i] != NULL; i++)
        printf("%s  %s %s\n", i == 0 ? "Examples:\n" : "", p->name, p->examples[i]);
    if (p->shown[0] != NULL)
        print_readers(p);
}

/* ------------------------------------------------------------------------------------------------ the man page */

/* Prints a character, escaped for roff. */
static void print_letter(char c)
{
    static const char special[] = "\\-^~`'";
    static const char *const names[] = {"\\e", "\\-", "\\(ha", "\\(ti", "\\(ga", "\\(aq"};
    const char *found = c != '\0' ? strchr(special, c) : NULL;
    if (found != NULL)
        fputs(names[found - special], stdout);
    else
        putchar(c);
}

static void print_letters(const char *text, int count)
{
    for (int i = 0; i < count; i++)
        print_letter(text[i]);
}

/* Prints text that is escaped for roff. */
static void print_roff(const char *format, ...)
{
    static char text[16384];
    va_list arguments;
    va_start(arguments, format);
    print_letters(text, vsnprintf(text, sizeof text, format, arguments));
    va_end(arguments);
}

static void print_section(const char *name)
{
    printf(".SH %s\n", name);
}

/* An empty line ends a paragraph. */
static void print_paragraphs(const char *text)
{
    for (const char *line = text + (text[0] == '\n'); *line != '\0';) {
        const int length = line_length(line);
        print_letters(line, length);
        puts(length > 0 ? "" : ".PP");
        line += length;
        line += *line == '\n';
    }
}

static void print_man_option(size_t i)
{
    const cli_option *o = cli_option_at(i);
    const char *short_name = strcmp(o->name, "output") == 0 ? "-o FILE, " : strcmp(o->name, "help") == 0 ? "-h, " : "";
    fputs(".TP\n.B ", stdout);
    print_roff("%s--%s%s%s\n", short_name, o->name, space_before(o->value), or_nothing(o->value));
    if (o->help != NULL) {
        const int first = line_length(o->help);
        print_roff("%.*s\n", first, o->help);
        if (o->help[first] != '\0') {
            puts(".br");
            print_paragraphs(o->help + first);
        }
    }
    if (o->kind == CLI_FLAG)
        return;
    if (o->help != NULL)
        puts(".br");
    const bool standard = cli_default(i)[0] != '\0';
    print_roff("Value: %s%s%s%s\n", cli_expectation(o), standard ? " (default: " : "", cli_default(i),
               standard ? ")" : "");
}

/* By convention, the title of a man page is the name in upper case. */
static void print_title(void)
{
    fputs(".TH ", stdout);
    for (const char *c = cli_asked.program->name; *c != '\0'; c++)
        print_letter((char)toupper((unsigned char)*c));
    printf(" 1 \"\" \"springstep %s\" \"User Commands\"\n", spring_version());
}

static void print_output(const cli_program *p)
{
    print_section("OUTPUT");
    puts("Tab\\-separated values. Lines that start with # record how the table was made. They are followed by the\n"
         "names of the columns and by the rows.");
    if (p->columns != NULL) {
        puts(".PP\nColumns:");
        print_roff("%s\n", p->columns);
    }
    if (p->meaning != NULL) {
        puts(".PP");
        print_paragraphs(p->meaning);
    }
}

void cli_print_man(void)
{
    const cli_program *p = cli_asked.program;
    print_title();
    print_section("NAME");
    print_roff("%s", p->name);
    fputs(" \\- ", stdout);
    print_roff("%s\n", p->summary);
    print_section("SYNOPSIS");
    fputs(".B ", stdout);
    print_roff("%s\n", p->name);
    for (const cli_option *o = p->options; o->name != NULL; o++)
        if (o->required) {
            fputs(".B ", stdout);
            print_roff("--%s\n", o->name);
            printf(".I %s\n", o->value);
        }
    puts(".RI [ OPTION ]...");
    print_section("DESCRIPTION");
    print_paragraphs(p->details != NULL ? p->details : p->summary);
    print_section("OPTIONS");
    puts("Numbers are decimal (1e\\-4) or hexadecimal (0x1p\\-13); whole numbers may be written 1e7. If an "
         "option\n"
         "is given several times, the last one counts, unless its description says otherwise.");
    for (size_t i = 0; cli_option_at(i) != NULL; i++)
        print_man_option(i);
    print_output(p);
    print_section("EXIT STATUS");
    puts("0: success. 1: the computation failed, or a check failed. 2: invalid usage. 3: cannot read or write. If the\n"
         "output is a closed pipe, SIGPIPE ends the program without a message.");
    if (p->examples[0] != NULL) {
        print_section("EXAMPLES");
        puts(".nf");
        for (int i = 0; i < EXAMPLES && p->examples[i] != NULL; i++)
            print_roff("%s %s\n", p->name, p->examples[i]);
        puts(".fi");
    }
    print_section("SEE ALSO");
    puts(".BR spring\\-methods (1),\n.BR spring\\-plan (1),\n.BR spring\\-run (1),\n.BR spring\\-scene (1),\n"
         ".BR spring\\-sweep (1)");
}

/* ------------------------------------------------------------------------------------------- for completion */

static const char *kind_of_value(const cli_option *o)
{
    switch (o->kind) {
    case CLI_FLAG:
        return "flag";
    case CLI_CHOICE:
    case CLI_METHOD:
        return "words";
    case CLI_FILE:
    case CLI_INPUT:
        return "file";
    case CLI_FOLDER:
        return "folder";
    default:
        return "value";
    }
}

/* Prints a line for each option: its name, the kind of its value, its valid words. */
void cli_print_completion(void)
{
    const cli_option *o;
    for (size_t i = 0; (o = cli_option_at(i)) != NULL; i++)
        printf("--%s %s %s\n", o->name, kind_of_value(o), cli_word_list(o, " "));
}
