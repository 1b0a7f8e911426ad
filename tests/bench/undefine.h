/* What a generated vars.h defines beside its struct, gone again for the next one. */
#undef vars
#undef VARS_H
#undef FMU_NAME
#undef FMU_TOKEN
#undef FMU_TICK_NS
#undef FMU_GRID
#undef FMU_GRID_NAME
#undef FMU_STRICT
#undef FMU_STRING_MAX
#undef FMU_NVARS
#undef FMU_NREFS
