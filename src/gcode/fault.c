#include "fault.h"

enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length)
{
    r->at = at;
    r->length = length;
    r->other_length = 0;
    return f;
}

const char *fault_text(enum fault f)
{
    switch (f) {    /* no table: one of pointers would not be constant in a shared library */
    case FAULT_NONE:         return "no fault";
    case FAULT_CHARACTER:    return "unexpected character";
    case FAULT_NUMBER:       return "number expected after";
    case FAULT_DIGITS:       return "number with too many digits";
    case FAULT_ZERO:         return "byte 0, which no text has, behind";
    case FAULT_LINE_LENGTH:  return "line longer than 256 characters";
    case FAULT_WORD_COUNT:   return "too many words in the line";
    case FAULT_READ:         return "the program cannot be read";
    case FAULT_COMMENT:      return "comment without )";
    case FAULT_WORD:         return "unknown word";
    case FAULT_TWICE:        return "word given twice";
    case FAULT_GROUP:        return "second word of one modal group";
    case FAULT_M_COUNT:      return "more than four M words in the line";
    case FAULT_SHARED:       return "two codes take the same words";
    case FAULT_UNUSED:       return "word has no use in this line";
    case FAULT_VALUE:        return "value out of range";
    case FAULT_NO_MOTION:    return "axis word without G0, G1, G2 or G3";
    case FAULT_NO_DWELL:     return "G4 without P";
    case FAULT_NO_AXES:      return "no axis word";
    case FAULT_NO_SYSTEM:    return "G10 needs L2 and P0 to P6";
    case FAULT_NO_OUTPUT:    return "output without P0 to P31";
    case FAULT_G53:          return "G53 needs G0 or G1";
    case FAULT_AXIS:         return "axis is not active";
    case FAULT_NO_CENTRE:    return "arc without centre or radius";
    case FAULT_CENTRE_AND_R: return "arc with both centre and radius";
    case FAULT_ARC_RADIUS:   return "arc of radius zero";
    case FAULT_ARC_END:      return "arc end does not lie on the circle through its start";
    case FAULT_ARC_CHORD:    return "arc radius is smaller than half the distance to the end";
    case FAULT_ARC_CLOSED:   return "arc is not determined by its points";
    case FAULT_FEED:         return "feed above max_feed [mm/min]";
    case FAULT_SPEED:        return "feed drives an axis above max_rpm [rpm]";
    case FAULT_RANGE:        return "position does not fit the 32-bit pulse counter";
    case FAULT_TRAVEL:       return "path leaves the software limits";
    case FAULT_COUNT:        break;
    }
    return "";
}
