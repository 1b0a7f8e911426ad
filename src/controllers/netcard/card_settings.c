#include "card_settings.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { FPGA_NS = 20 };

struct card_settings card_settings_start(void)
{
    struct card_settings s;

    memset(&s, 0, sizeof s);
#define START(type, name, elements, unit, start, low, high, words) \
    for (size_t i = 0; i < sizeof s.name / sizeof(type); i++) { \
        ((type *)&s.name)[i] = (type)(start); \
    }
    CARD_SETTINGS(START)
    return s;
}

static bool within(struct card_wrong *w, const char *name, size_t index, double value, double low,
                   double high)
{
    *w = (struct card_wrong){ name, NULL, (int32_t)index, value, low, high };
    return value >= low && value <= high;
}

static bool refuse(struct card_wrong *w, const char *name, int index, double value, const char *why)
{
    *w = (struct card_wrong){ name, why, index, value, value, value };
    return false;
}

static bool clocks(struct card_wrong *w, const char *name, int32_t ns)
{
    return ns % FPGA_NS == 0 || refuse(w, name, 0, ns, "not a whole number of 20 ns clocks");
}

bool card_settings_good(const struct card_settings *s, struct card_wrong *wrong)
{
#define WITHIN(type, name, elements, unit, start, low, high, words) \
    for (size_t i = 0; i < sizeof s->name / sizeof(type); i++) { \
        if (!within(wrong, #name, i, (double)((const type *)&s->name)[i], low, high)) { \
            return false; \
        } \
    }
    CARD_SETTINGS(WITHIN)
    for (int i = 0; i < CARD_AXES; i++) {
        if (s->position_low[i] > s->position_high[i]) {
            return refuse(wrong, "position_low", i, s->position_low[i], "above position_high");
        }
        if (s->speed_min[i] > s->speed_max[i]) {
            return refuse(wrong, "speed_min", i, s->speed_min[i], "above speed_max");
        }
        if (s->home_speed[i] > s->speed_max[i]) {
            return refuse(wrong, "home_speed", i, s->home_speed[i], "above speed_max");
        }
    }
    if (s->program_us > s->program_most_us) {
        return refuse(wrong, "program_us", 0, s->program_us, "above program_most_us");
    }
    if (s->erase_ms > s->erase_most_ms) {
        return refuse(wrong, "erase_ms", 0, s->erase_ms, "above erase_most_ms");
    }
    if (s->block_ms > s->block_most_ms) {
        return refuse(wrong, "block_ms", 0, s->block_ms, "above block_most_ms");
    }
    return clocks(wrong, "period_ns", s->period_ns)
           && clocks(wrong, "pulse_width_ns", s->pulse_width_ns)
           && clocks(wrong, "dir_setup_ns", s->dir_setup_ns)
           && clocks(wrong, "dir_hold_ns", s->dir_hold_ns);
}

/* Place, type and range of each setting in struct card_settings, in the order of their numbers. */
enum kind { KIND_BOOL, KIND_INT, KIND_DOUBLE };
#define KIND(x) _Generic((x), bool: KIND_BOOL, int32_t: KIND_INT, double: KIND_DOUBLE)
#define PLACE(type, name, elements, unit, start, low, high, words) \
    { offsetof(struct card_settings, name), \
      sizeof((struct card_settings *)0)->name / sizeof(type), KIND((type)0) },
static const struct place {
    size_t offset, count;
    enum kind kind;
} places[] = { CARD_SETTINGS(PLACE) };

static bool there(int id, int index)
{
    return id >= 0 && id < CARD_SETTING_COUNT && index >= 0 && (size_t)index < places[id].count;
}

bool card_settings_get(const struct card_settings *s, int id, int index, int64_t *value)
{
    if (!there(id, index)) {
        return false;
    }
    const char *at = (const char *)s + places[id].offset;
    switch (places[id].kind) {
    case KIND_BOOL: *value = ((const bool *)at)[index]; break;
    case KIND_INT:  *value = ((const int32_t *)at)[index]; break;
    default:        *value = llround(((const double *)at)[index]);
    }
    return true;
}

bool card_settings_set(struct card_settings *s, int id, int index, int64_t value)
{
    struct card_settings next = *s;
    struct card_wrong wrong;

    if (!there(id, index)) {
        return false;
    }
    char *at = (char *)&next + places[id].offset;
    switch (places[id].kind) {
    case KIND_BOOL:
        if (value != 0 && value != 1) {
            return false;
        }
        ((bool *)at)[index] = value;
        break;
    case KIND_INT:
        if (value < INT32_MIN || value > INT32_MAX) {
            return false;
        }
        ((int32_t *)at)[index] = (int32_t)value;
        break;
    default: ((double *)at)[index] = (double)value;
    }
    if (!card_settings_good(&next, &wrong)) {
        return false;
    }
    *s = next;
    return true;
}
