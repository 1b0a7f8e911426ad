#include "fault.h"

static const char *const texts[] = {
    [FAULT_NONE]         = "no fault",
    [FAULT_CHARACTER]    = "unexpected character",
    [FAULT_NUMBER]       = "number expected after",
    [FAULT_DIGITS]       = "number with too many digits",
    [FAULT_LINE_LENGTH]  = "line longer than 256 characters",
    [FAULT_WORD_COUNT]   = "too many words in the line",
    [FAULT_COMMENT]      = "comment without )",
    [FAULT_WORD]         = "unknown word",
    [FAULT_TWICE]        = "word given twice",
    [FAULT_GROUP]        = "second word of one modal group",
    [FAULT_UNUSED]       = "word has no use in this line",
    [FAULT_VALUE]        = "value out of range",
    [FAULT_NO_MOTION]    = "axis word without G0, G1, G2 or G3",
    [FAULT_NO_DWELL]     = "G4 without P",
    [FAULT_NO_AXES]      = "no axis word",
    [FAULT_G53]          = "G53 needs G0 or G1",
    [FAULT_AXIS]         = "axis is not active",
    [FAULT_NO_CENTRE]    = "arc without centre or radius",
    [FAULT_CENTRE_AND_R] = "arc with both centre and radius",
    [FAULT_ARC_RADIUS]   = "arc of radius zero",
    [FAULT_ARC_END]      = "arc end does not lie on the circle through its start",
    [FAULT_ARC_CHORD]    = "arc radius is smaller than half the distance to the end",
    [FAULT_ARC_CLOSED]   = "arc is not determined by its points",
    [FAULT_FEED]         = "feed above max_feed [mm/min]",
    [FAULT_SPEED]        = "feed drives an axis above max_rpm [rpm]",
    [FAULT_RANGE]        = "position does not fit the 32-bit pulse counter",
};
_Static_assert(sizeof texts / sizeof *texts == FAULT_COUNT, "one text per fault");

enum fault fault_at(struct fault_report *r, enum fault f, int64_t at, int64_t length)
{
    r->at = at;
    r->length = length;
    return f;
}

const char *fault_text(enum fault f)
{
    return texts[f];
}

int fault_code(enum fault f)
{
    return f == FAULT_NONE ? 0 : f == FAULT_FEED || f == FAULT_SPEED ? -7 : -5;
}
