/* SPDX-License-Identifier: MIT */
/* The journal of a part of a sweep; see journal.h. */
#define _XOPEN_SOURCE 700
#include "sweep/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

char journal_message[1000];

/* The position of an intact block in a file. */
typedef struct record {
    uint64_t block;
    long long begin, end;
} record;

struct journal {
    const char *path;
    char target[PATH_MAX]; /* of the path, if it is a symbolic link; only for a damaged file */
    char other[PATH_MAX];  /* replacement of a damaged file, until it is complete */
    FILE *in;              /* the existing file; kept open, because closing it would release the lock */
    int fd;                /* the file being written */
    bool made;             /* the file did not exist before */
    int damaged_fd;        /* the file being replaced; -1: none */
    long long end;         /* end of the last complete block written */
    record *later;         /* [laters] intact blocks after the damage */
    size_t laters, taken;
    uint64_t next;         /* the first block that is not known to be in the file */
    uint64_t first, every; /* blocks first, first + every, ... */
    uint64_t blocks;       /* of the whole sweep */
    time_t synced;
};

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
static bool
refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(journal_message, sizeof journal_message, format, arguments);
    va_end(arguments);
    return false;
}

/* ------------------------------------------------------------------------------------------------------- the record */

/* CRC-32 of IEEE 802.3, bit by bit reflected: polynomial 0xedb88320. Source: RFC 1952, section 8. */
static uint32_t crc_of(uint32_t crc, const char *bytes, size_t length)
{
    static uint32_t table[256];
    if (table[1] == 0)
        for (uint32_t i = 0; i < 256; i++) {
            uint32_t c = i;
            for (int bit = 0; bit < 8; bit++)
                c = (c & 1) != 0 ? c >> 1 ^ 0xedb88320 : c >> 1;
            table[i] = c;
        }
    crc = ~crc;
    for (size_t i = 0; i < length; i++)
        crc = table[(crc ^ (unsigned char)bytes[i]) & 0xff] ^ crc >> 8;
    return ~crc;
}

static const char ending[] = "# block ";

enum { longest_ending = sizeof "# block 18446744073709551615 ffffffff\n" };

/* Prints the last line of a block. The CRC includes the number of the block. */
static size_t print_ending(char *line, uint64_t block, const char *rows, size_t length)
{
    const int digits = snprintf(line, longest_ending, "%s%" PRIu64, ending, block);
    const uint32_t crc = crc_of(crc_of(0, line, (size_t)digits), rows, length);
    return (size_t)snprintf(line, longest_ending, "%s%" PRIu64 " %08" PRIx32 "\n", ending, block, crc);
}

enum { longest_line = 65536 }; /* [bytes] longest header */

/* Appends a line with its "\n" to *text; false: there is no complete line. */
static bool append_line(FILE *in, char **text, size_t *length, size_t *size)
{
    int c;
    const size_t most = *length + longest_line;
    while ((c = getc_unlocked(in)) != EOF) {
        if (*length + 1 >= *size) {
            *size = 2 * *size + 4096;
            char *larger = realloc(*text, *size);
            if (larger == NULL)
                return false;
            *text = larger;
        }
        (*text)[(*length)++] = (char)c;
        (*text)[*length] = '\0';
        if (c == '\n')
            return true;
        if (*length == most)
            return false;
    }
    return false;
}

/* Reads rows up to and including the next line that looks like the end of a block. False: there is none. */
static bool read_record(FILE *in, char **text, size_t *length, size_t *size, uint64_t *block, bool *whole)
{
    *length = 0;
    for (;;) {
        const size_t line = *length;
        if (!append_line(in, text, length, size))
            return false;
        if (strncmp(*text + line, ending, sizeof ending - 1) != 0)
            continue;
        char expected[longest_ending];
        *block = strtoull(*text + line + sizeof ending - 1, NULL, 10);
        print_ending(expected, *block, *text, line);
        *whole = strcmp(expected, *text + line) == 0;
        *length = line;
        return true;
    }
}

/* ---------------------------------------------------------------------------------------------------------- writing */

/* Writes all or nothing: a partial write is truncated. */
static bool write_at_end(journal *j, const char *bytes, size_t length)
{
    size_t done = 0;
    while (done < length) {
        const ssize_t written = pwrite(j->fd, bytes + done, length - done, (off_t)(j->end + (long long)done));
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            const int reason = written == 0 ? ENOSPC : errno;
            refuse("cannot write \"%s\": %s", j->path, strerror(reason));
            if (ftruncate(j->fd, (off_t)j->end) != 0)
                return false; /* the next open truncates it */
            return false;
        }
        done += (size_t)written;
    }
    j->end += (long long)length;
    return true;
}

/* Protects against a crash of the machine. After a crash of the process alone, written data are safe without it. */
static bool sync_now(journal *j)
{
    j->synced = time(NULL);
    return fsync(j->fd) == 0 || refuse("cannot write \"%s\": %s", j->path, strerror(errno));
}

static bool lock(const journal *j, int fd)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(fd, F_SETLK, &whole) == 0)
        return true;
    if (errno == EACCES || errno == EAGAIN)
        return refuse("\"%s\" is being written by another process", j->path);
    refuse("cannot lock \"%s\": %s", j->path, strerror(errno));
    if (j->made)
        unlink(j->path);
    return false;
}

/* ---------------------------------------------------------------------------------------------------- what is there */

static bool keep_later(journal *j, uint64_t block, long long begin, long long end)
{
    if ((j->laters & (j->laters - 1)) == 0) { /* full: 0 or a power of two */
        record *more = realloc(j->later, (j->laters == 0 ? 1 : 2 * j->laters) * sizeof *more);
        if (more == NULL)
            return refuse("out of memory");
        j->later = more;
    }
    j->later[j->laters++] = (record){block, begin, end};
    return true;
}

static bool is_ours(const journal *j, uint64_t block)
{
    return block < j->blocks && block >= j->first && (block - j->first) % j->every == 0;
}

/* Finds the end of the intact blocks, and intact blocks after damaged ones. */
static bool scan(journal *j)
{
    char *text = NULL;
    size_t length, size = 0;
    uint64_t block, next = j->first;
    bool whole, kept = true, broken = false;
    while (kept && read_record(j->in, &text, &length, &size, &block, &whole)) {
        const long long end = ftello(j->in);
        whole = whole && is_ours(j, block) && block >= next;
        broken = broken || !whole || block != j->next;
        if (!broken) {
            j->end = end;
            next = j->next = block + j->every;
        } else if (whole) {
            char line[longest_ending];
            kept =
                keep_later(j, block, end - (long long)length - (long long)print_ending(line, block, text, length), end);
            next = block + j->every;
        }
    }
    free(text);
    return kept;
}

/* Returns true if the file starts with the header. If the file ends within the header, it was torn there. */
static bool has_header(const char *path, FILE *in, const char *header, bool *torn)
{
    const size_t length = strlen(header);
    char *start = malloc(length + 1);
    if (start == NULL)
        return refuse("out of memory");
    const size_t read = fread(start, 1, length, in);
    start[read] = '\0';
    *torn = read < length;
    size_t same = 0, line = 0;
    for (; same < read && start[same] == header[same]; same++)
        if (header[same] == '\n')
            line = same + 1;
    if (same < read)
        refuse("\"%s\" exists, but is not this part of this sweep: it has \"%.*s\" instead of \"%.*s\"", path,
               (int)strcspn(start + line, "\n"), start + line, (int)strcspn(header + line, "\n"), header + line);
    free(start);
    return same == read;
}

static bool take_over(journal *j, const char *header)
{
    bool torn = false, done = has_header(j->path, j->in, header, &torn);
    if (done && !torn) {
        j->end = (long long)strlen(header);
        done = scan(j);
    }
    if (done && torn)
        done = (ftruncate(j->fd, 0) == 0 || refuse("cannot write \"%s\": %s", j->path, strerror(errno))) &&
               write_at_end(j, header, strlen(header));
    return done;
}

static bool copy_range(journal *j, int from, long long begin, long long end)
{
    char bytes[65536];
    while (begin < end) {
        const size_t wanted = end - begin < (long long)sizeof bytes ? (size_t)(end - begin) : sizeof bytes;
        const ssize_t read = pread(from, bytes, wanted, (off_t)begin);
        if (read <= 0)
            return refuse("cannot read \"%s\": %s", j->path, read < 0 ? strerror(errno) : "it became shorter");
        if (!write_at_end(j, bytes, (size_t)read))
            return false;
        begin += read;
    }
    return true;
}

/* A second file receives all intact and repeated blocks, in order. It replaces the first file once all intact blocks
   are copied. A symbolic link is kept. */
static bool begin_repair(journal *j)
{
    const long long good = j->end;
    if (realpath(j->path, j->target) == NULL)
        return refuse("cannot write \"%s\": %s", j->path, strerror(errno));
    if (snprintf(j->other, sizeof j->other, "%s.repair", j->target) >= (int)sizeof j->other)
        return refuse("cannot write \"%s\": its name is too long", j->path);
    const int fd = open(j->other, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return refuse("cannot write \"%s\": %s", j->other, strerror(errno));
    j->damaged_fd = j->fd;
    j->fd = fd;
    j->end = 0;
    return lock(j, fd) && copy_range(j, j->damaged_fd, 0, good);
}

static bool end_repair(journal *j)
{
    if (!sync_now(j))
        return false;
    if (rename(j->other, j->target) != 0)
        return refuse("cannot replace \"%s\": %s", j->path, strerror(errno));
    close(j->damaged_fd);
    j->damaged_fd = -1;
    return true;
}

/* ----------------------------------------------------------------------------------------------- is it still there? */

/* Copies a removed file that is still open to a new file with its name. */
static bool write_again(journal *j)
{
    const int removed = j->fd;
    const long long end = j->end;
    const int fd = open(j->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return refuse("\"%s\" was removed during the run, and cannot be restored: %s", j->path, strerror(errno));
    j->fd = fd;
    j->end = 0;
    const bool done = lock(j, fd) && copy_range(j, removed, 0, end) && sync_now(j);
    close(removed);
    return done && refuse("\"%s\" was removed during the run; it has been restored, and the same command "
                          "continues it",
                          j->path);
}

/* Checks that the path still refers to the open file. Otherwise its rows would be lost when it is closed. */
static bool check_name(journal *j)
{
    struct stat own, named;
    const char *path = j->damaged_fd >= 0 ? j->other : j->path;
    if (fstat(j->fd, &own) != 0)
        return refuse("cannot write \"%s\": %s", path, strerror(errno));
    const bool there = stat(path, &named) == 0;
    if (there && named.st_dev == own.st_dev && named.st_ino == own.st_ino)
        return true;
    if (!there && own.st_nlink == 0 && j->damaged_fd < 0)
        return write_again(j);
    return refuse("\"%s\" was moved or replaced during the run; it should stay in place until the end", path);
}

/* ----------------------------------------------------------------------------------------------------- what is seen */

journal *journal_open(const char *path, const char *header, uint64_t first, uint64_t every, uint64_t blocks)
{
    journal *j = malloc(sizeof *j);
    if (j == NULL) {
        refuse("out of memory");
        return NULL;
    }
    *j = (journal){.path = path, .damaged_fd = -1, .next = first, .first = first, .every = every, .blocks = blocks};
    j->fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    j->made = j->fd >= 0;
    if (!j->made)
        j->fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    struct stat status;
    if (j->fd >= 0)
        j->in = fopen(path, "r");
    if (j->fd < 0 || j->in == NULL || fstat(j->fd, &status) != 0)
        refuse("cannot write \"%s\": %s", path, strerror(errno));
    else if (!S_ISREG(status.st_mode))
        refuse("cannot write \"%s\": a part should be a file", path);
    else if (lock(j, j->fd) && take_over(j, header) &&
             (j->laters > 0
                  ? begin_repair(j)
                  : ftruncate(j->fd, (off_t)j->end) == 0 || refuse("cannot write \"%s\": %s", path, strerror(errno))))
        return j;
    char message[sizeof journal_message];
    strcpy(message, journal_message);
    journal_close(j);
    strcpy(journal_message, message);
    return NULL;
}

bool journal_fits(const char *path, const char *header)
{
    FILE *in = fopen(path, "r");
    bool torn;
    const bool fits = in == NULL || has_header(path, in, header, &torn);
    if (in != NULL)
        fclose(in);
    return fits;
}

bool journal_damaged(const journal *j)
{
    return j->laters > 0;
}

bool journal_has(journal *j, uint64_t block, bool *there)
{
    *there = block < j->next;
    if (j->taken == j->laters || j->later[j->taken].block != block)
        return true;
    const record *r = &j->later[j->taken++];
    *there = true;
    j->next = block + j->every;
    return copy_range(j, j->damaged_fd, r->begin, r->end) && (j->taken < j->laters || end_repair(j));
}

bool journal_add(journal *j, uint64_t block, const char *rows, size_t length)
{
    char *text = malloc(length + longest_ending);
    if (text == NULL)
        return refuse("out of memory");
    memcpy(text, rows, length);
    const size_t line = print_ending(text + length, block, rows, length);
    const bool written = write_at_end(j, text, length + line);
    free(text);
    if (!written)
        return false;
    j->next = block + j->every;
    return time(NULL) == j->synced || (sync_now(j) && check_name(j));
}

bool journal_close(journal *j)
{
    if (j == NULL)
        return true;
    bool done = true;
    if (j->fd >= 0) {
        done = sync_now(j) && (j->end == 0 || check_name(j));
        if (close(j->fd) != 0 && done)
            done = refuse("cannot write \"%s\": %s", j->path, strerror(errno));
    }
    if (j->damaged_fd >= 0) { /* the repair failed, so the old file is kept */
        close(j->damaged_fd);
        unlink(j->other);
    }
    if (j->in != NULL)
        fclose(j->in);
    free(j->later);
    free(j);
    return done;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static FILE *open_at(const journal_reader *reader)
{
    FILE *in = fopen(reader->path, "r");
    if (in == NULL)
        refuse("cannot read \"%s\": %s", reader->path, strerror(errno));
    else if (fseeko(in, (off_t)reader->offset, SEEK_SET) != 0) {
        refuse("cannot read \"%s\": %s", reader->path, strerror(errno));
        fclose(in);
        in = NULL;
    }
    return in;
}

char *journal_header(const char *path, journal_reader *reader)
{
    *reader = (journal_reader){.path = path};
    FILE *in = open_at(reader);
    if (in == NULL)
        return NULL;
    char *text = NULL;
    size_t length = 0, size = 0, line = 0;
    int number = 0;
    bool more = true;
    while (more) {
        number++;
        line = length;
        more = append_line(in, &text, &length, &size) && length <= longest_line;
        if (more && text[line] != '#')
            break;
    }
    reader->offset = (long long)length;
    fclose(in);
    if (more)
        return text;
    free(text);
    refuse("\"%s\" is not a part of a sweep: its header should be whole lines of at most %d bytes in all (line %d)",
           path, longest_line, number);
    return NULL;
}

char *journal_read(journal_reader *reader, uint64_t block, size_t *length)
{
    FILE *in = open_at(reader);
    if (in == NULL)
        return NULL;
    char *text = NULL;
    size_t size = 0;
    uint64_t found = 0;
    bool whole = false;
    const bool there = read_record(in, &text, length, &size, &found, &whole);
    const long long offset = ftello(in);
    fclose(in);
    if (there && whole && found == block) {
        reader->offset = offset;
        return text;
    }
    free(text);
    refuse("\"%s\": block %" PRIu64 " is %s; run this part again", reader->path, block,
           !there ? "missing or torn" : "damaged, or not in its place");
    return NULL;
}

bool journal_ends(const journal_reader *reader)
{
    FILE *in = open_at(reader);
    if (in == NULL)
        return false;
    const bool ends = getc(in) == EOF;
    fclose(in);
    return ends || refuse("\"%s\" has more than its last block", reader->path);
}
