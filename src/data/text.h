/* text.h - lines and words of a text file */
#ifndef ASPI_TEXT_H
#define ASPI_TEXT_H

#include "measured.h"

typedef struct aspi_word { const char *text; size_t length; } aspi_word;

/* One line without its end; lines end in \n, \r\n or \r. */
typedef struct aspi_line { const char *text; size_t length; long long number; } aspi_line;

typedef struct aspi_lines { const char *at, *end; long long number; } aspi_lines;

aspi_lines aspi_lines_of(const aspi_bytes *file);              /* skips a byte order mark */
int aspi_next_line(aspi_lines *lines, aspi_line *line);        /* 0 at the end */

/* Is it text: no control characters but tab and line ends in the first 4 KB. */
int aspi_is_text(const aspi_bytes *file);

aspi_line aspi_trimmed(aspi_line line);                        /* without blanks at both ends */
int aspi_is_comment(aspi_line trimmed, aspi_line *content);    /* '#'; content may be NULL */

/* What separates words: ';' where there is one, else ',', else blanks (' '). */
char aspi_separator(aspi_line line);
/* Splits into words without blanks and quotes around them; writes at most `room`, returns how many
 * there are. */
size_t aspi_split(aspi_line line, char separator, aspi_word *word, size_t room);

int aspi_word_is(aspi_word word, const char *text);            /* upper and lower case are one */
int aspi_word_number(aspi_word word, double *out);

#endif
