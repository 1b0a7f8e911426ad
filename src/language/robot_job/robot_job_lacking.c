/* robot_job_lacking - words of INFORM that mean something to a pendant's controller, and nothing to
 * this one: a program that needs them is refused by their name. */
#include <stddef.h>

#include "robot_job_reading.h"

static const char WORDS[][9] = {
    "ABORT",    "ADVINIT", "ADVSTOP", "AND",     "ANTOUT",  "ARATIOF", "ARATION", "ARCCTE",
    "ARCCTS",   "ARCOF",   "ARCON",   "ARCSET",  "ASC",     "ATAN",    "AWELD",   "CAT",
    "CHR",      "CLEAR",   "CLS",     "CONT",    "COS",     "DELETEJ", "DI",      "DIALOG",
    "EI",       "EIMOVC",  "EIMOVL",  "EXPRESS", "FPT",     "GETFILE", "GETNAME", "GETPOS",
    "GETPRM",   "GETREG",  "GUNCL",   "HAND",    "HPMMVOF", "HPMMVON", "HPVELOF", "HPVELON",
    "HSEN",     "HTRAJOF", "HTRAJON", "INPUT",   "INVMAT",  "LEN",     "LOADJ",   "LOADV",
    "MACRO1",   "MACRO2",  "MFRAME",  "MID",     "MULMAT",  "NOT",     "OR",      "PRINT",
    "PSTART",   "PWAIT",   "REFP",    "SAVEJ",   "SAVEV",   "SETFILE", "SETPRM",  "SETREG",
    "SETTM",    "SETTOOL", "SETUALM", "SFTOF3D", "SFTON3D", "SHCKRST", "SHCKSET", "SIN",
    "SKILLSND", "SMOOTH",  "SMOVC",   "SMOVL",   "SPOT",    "SQRT",    "STROKE",  "STRSTR",
    "STRWAIT",  "SWAIT",   "TOOLOF",  "TOOLON",  "TSYNC",   "VAL",     "VAL2STR", "VE",
    "VWELD",    "WEAVE",   "WVOF",    "WVON",    "XOR"
};

bool robot_job_lacks(const struct robot_job_scan *s, struct robot_job_span w)
{
    for (size_t i = 0; i < sizeof WORDS / sizeof WORDS[0]; i++) {
        if (robot_job_scan_is(s, w, WORDS[i])) {
            return true;
        }
    }
    return false;
}
