/* el_cbrt_tables - constants of the cube root, for the files of this core.
 * Made by tests/elementary/tables.py, which computes every number. */
#ifndef EL_CBRT_TABLES_H
#define EL_CBRT_TABLES_H

/* coefficients of the cube root in 1 .. 2, to 12 bits, ascending powers */
static const double CBRT_START[5] = {
    0x1.04bc2bde493b9p-1, 0x1.6c697f83452edp-1, -0x1.2d024eeecb9cbp-2, 0x1.544aaec5e4624p-4,
    -0x1.4b077fcd0882bp-7
};

/* cube roots of 1, 2, 4 */
static const double CBRTS[3] = {
    0x1p+0, 0x1.428a2f98d728bp+0, 0x1.965fea53d6e3dp+0
};

#endif
