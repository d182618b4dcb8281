/* list_page.h - docs/distributions.md: a section for each distribution of the library */
#ifndef LIST_PAGE_H
#define LIST_PAGE_H

#include "asperity_ndf.h"

void list_page(void);

#endif
