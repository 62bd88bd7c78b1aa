/* What a power cut may take: the changes of files since each was last flushed. */
#ifndef ADIT_TESTS_CRASH_UNSYNCED_H
#define ADIT_TESTS_CRASH_UNSYNCED_H

#include <stddef.h>
#include <sys/types.h>

/* To be called before the change: `size` bytes will be written at `offset` of the file. */
void remember_write(int file, off_t offset, size_t size);
/* To be called before the file gets a new length. */
void remember_truncation(int file, off_t length);
/* The file was flushed: all its changes are on the disk. */
void forget_changes(int file);

/* Takes back, of each file's changes, all, the last ones, or the sectors that chance picks. One line about
   each file goes to `say`. */
void tear(unsigned seed, void (*say)(const char* line));

#endif
