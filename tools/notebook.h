/* notebook.h - the fits by hand in a notebook, beside the computed ones (notebook.c) */
#ifndef NOTEBOOK_H
#define NOTEBOOK_H

/* Prints the table, or JSON. CMD_OK or CMD_FAILED with the error printed. */
int notebook_table(int json);

#endif
