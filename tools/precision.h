/* precision.h - the name of a batch call in either precision, for code that is written once */
#ifndef PRECISION_H
#define PRECISION_H

#define N_64(name) name##_n
#define N_32(name) name##_nf

#endif
