/* SPDX-License-Identifier: MIT */
/*
 * The journal of a part of a sweep is its output file: a header, then blocks of rows, each ended by a line
 *
 *     # block K CRC
 *
 * that is written with the rows. A killed process loses the current block only, the CRC detects torn or damaged blocks,
 * and the next run continues after the last intact block. Blocks are in the order first, first + every, ...
 *
 * Nothing here prints or ends the program. A function that fails sets journal_message.
 */
#ifndef SPRINGSTEP_SWEEP_JOURNAL_H
#define SPRINGSTEP_SWEEP_JOURNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct journal journal;

/* The error message, with the name of the file. */
extern char journal_message[1000];

/**
 * Opens or creates the file of a part. It is locked until journal_close().
 *
 * @param header  the lines with which the file must start
 * @return NULL: the file is in use, belongs to another part, or cannot be read or written
 */
journal *journal_open(const char *path, const char *header, uint64_t first, uint64_t every, uint64_t blocks);

/** Returns true if the file does not exist, or starts with the header, possibly torn. Does not write or lock. */
bool journal_fits(const char *path, const char *header);

/** Returns true if there are intact blocks after damaged ones. Intact blocks are kept, the others are repeated. */
bool journal_damaged(const journal *j);

/** Looks a block up. Call it in the order of the blocks, and add a missing block before the next call. */
bool journal_has(journal *j, uint64_t block, bool *there);
bool journal_add(journal *j, uint64_t block, const char *rows, size_t length);

/** Closes the complete journal. Fails if the file was moved, replaced or removed; a removed file is written again
    first. Accepts NULL, and can be called after a failure. */
bool journal_close(journal *j);

/* --------------------------------------------------------------------------------------------------------- reading */

/* Complete parts are read block by block with one open file, because there can be more parts than open files. */
typedef struct journal_reader {
    const char *path;
    long long offset; /* position of the next block */
} journal_reader;

/** Returns the header of a file, up to and including the first line that does not start with "#"; release it with
    free(). NULL: the file cannot be read, or there is no such line. */
char *journal_header(const char *path, journal_reader *reader);

/** Returns the rows of the next block, which must be `block`; release them with free(). NULL: missing or damaged. */
char *journal_read(journal_reader *reader, uint64_t block, size_t *length);

/** Returns true if the file ends after the last block that was read. */
bool journal_ends(const journal_reader *reader);

#endif
