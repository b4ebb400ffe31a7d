/* SPDX-License-Identifier: MIT */
/* The clock of tools that measure time; see timing.h. */
#define _DEFAULT_SOURCE /* clock_gettime, getloadavg */
#include "common/timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

static double now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

double timing_now(void)
{
    return now(CLOCK_MONOTONIC);
}

double timing_busy(void)
{
    return now(CLOCK_PROCESS_CPUTIME_ID);
}

/* The model of the processor on Linux, elsewhere its architecture. */
static void stamp_processor(cli_table *table)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (colon != NULL && strncmp(line, "model name", strlen("model name")) == 0) {
            cli_comment(table, "processor:%.*s", (int)strcspn(colon + 1, "\n"), colon + 1);
            fclose(file);
            return;
        }
    }
    if (file != NULL)
        fclose(file);
    struct utsname system;
    cli_comment(table, "processor: %s", uname(&system) >= 0 ? system.machine : "unknown");
}

void timing_stamp(cli_table *table)
{
    cli_comment(table, "flags: %s", SPRING_FLAGS);
    stamp_processor(table);
    double load;
    if (getloadavg(&load, 1) == 1)
        cli_comment(table, "load: %.2f processes in the last minute", load);
    char date[32];
    const time_t now = time(NULL);
    if (strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", gmtime(&now)) > 0)
        cli_comment(table, "date: %s", date);
}
