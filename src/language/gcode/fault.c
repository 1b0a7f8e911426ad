#include "fault.h"

#include <string.h>

enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length)
{
    r->at = at;
    r->length = length;
    r->other_length = 0;
    return f;
}

void fault_note(struct fault_report *r, enum fault what, int32_t at, int32_t length)
{
    int i = 0;

    while (i < r->notes && r->note[i].what != what) {
        i++;
    }
    if (i == r->notes) {
        r->note[r->notes] = (struct fault_note){ what, r->line, at, length, r->offset, "" };
        memcpy(r->note[r->notes++].file, r->file, FAULT_FILE);
    }
}

const char *fault_text(enum fault f)
{
    switch (f) {    /* no table: one of pointers would not be constant in a shared library */
    case FAULT_NONE:         return "no fault";
    case FAULT_CHARACTER:    return "unexpected character";
    case FAULT_NUMBER:       return "number expected after";
    case FAULT_DIGITS:       return "number of more than 120 digits";
    case FAULT_ZERO:         return "byte 0, which no text has, behind";
    case FAULT_LINE_LENGTH:  return "line longer than 256 characters";
    case FAULT_WORD_COUNT:   return "too many words in the line";
    case FAULT_READ:         return "the program cannot be read";
    case FAULT_COMMENT:      return "comment without )";
    case FAULT_BRACKET:      return "[ ] expected";
    case FAULT_OPERATOR:     return "operation or ] expected";
    case FAULT_NAME:         return "a name has 1 to 31 characters between < and >";
    case FAULT_ATAN:         return "ATAN needs [ ]/[ ]";
    case FAULT_EXISTS:       return "EXISTS needs [#<name>]";
    case FAULT_ASSIGNMENT:   return "= expected behind";
    case FAULT_DEEP:         return "more than 30 brackets within one another";
    case FAULT_DIVISION:     return "division by zero";
    case FAULT_ARGUMENT:     return "no value for this argument";
    case FAULT_LARGE:        return "value too large";
    case FAULT_PARAMETER:    return "no such parameter";
    case FAULT_UNSET:        return "parameter has not been set";
    case FAULT_FOREIGN:      return "this machine has no value for";
    case FAULT_FIXED:        return "parameter cannot be set";
    case FAULT_NAMES:        return "more than 100 named parameters";
    case FAULT_O_WORD:       return "unknown O word";
    case FAULT_O_LABEL:      return "only a call may compute its O number";
    case FAULT_O_BEHIND:     return "O words allow no other word in their line";
    case FAULT_O_PLACE:      return "O word without its beginning";
    case FAULT_O_OPEN:       return "O number is open already";
    case FAULT_O_END:        return "O word without its end";
    case FAULT_O_NUMBER:     return "second O number without M2, M30 or M99 in front of it";
    case FAULT_O_DEEP:       return "more than 64 loops and conditions within one another";
    case FAULT_SEQUENCE:     return "no line of this program has this N";
    case FAULT_LOOP_END:     return "DO without the END of its number";
    case FAULT_THEN:         return "IF [ ] goes on with GOTO or THEN, WHILE [ ] with DO";
    case FAULT_ALARM:        return "alarm of the program";
    case FAULT_MODAL:        return "not while G66 is in force (G67 ends it)";
    case FAULT_NO_SUB:       return "no such subprogram";
    case FAULT_USER:         return "no subprogram of its name (o<m100> sub) says what it does:";
    case FAULT_FILES:        return "more than 32 files are called";
    case FAULT_CALLS:        return "more than 10 calls within one another";
    case FAULT_M99:          return "M99 in a subprogram that ends with endsub";
    case FAULT_ENDLESS:      return "1,000,000 lines read again without anything that takes time";
    case FAULT_ANGLE:
        return "this machine has no rotary axes (--angles: A B C in place of U V W)";
    case FAULT_SIDE:         return "this machine has A B C in place of the axes U V W";
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
    case FAULT_NO_SYSTEM:    return "G10 needs L2 or L20 and P0 to P9";
    case FAULT_NO_OUTPUT:    return "output without P0 to P31";
    case FAULT_G53:          return "G53 needs G0 or G1";
    case FAULT_AXIS:         return "axis is not active";
    case FAULT_NO_CENTRE:    return "arc without centre or radius";
    case FAULT_CENTRE_AND_R: return "arc with both centre and radius";
    case FAULT_ARC_RADIUS:   return "arc of radius zero";
    case FAULT_ARC_END:      return "arc end does not lie on the circle through its start";
    case FAULT_ARC_CHORD:    return "arc radius is smaller than half the distance to the end";
    case FAULT_ARC_CLOSED:   return "arc is not determined by its points";
    case FAULT_TURNING:      return "for turning; this is no lathe";
    case FAULT_NURBS:        return "G5.2 is not ended by G5.3 before";
    case FAULT_NURBS_END:    return "G5.2 is not ended by G5.3 behind";
    case FAULT_NURBS_NONE:   return "no G5.2 before";
    case FAULT_NURBS_FEW:    return "fewer points since G5.2 than its order L, or 3, before";
    case FAULT_NURBS_POINT:  return "point of a NURBS without both axes of the plane";
    case FAULT_NURBS_FEED:   return "NURBS with G93, in which a feed is that of one motion";
    case FAULT_SPLINE:       return "spline without control points (G5 I J P Q, G5.1 I J)";
    case FAULT_SPLINE_PLANE: return "splines are in the plane of G17";
    case FAULT_CUSP:         return "spline turns on the spot";
    case FAULT_PLAIN:        return "this machine drives no splines";
    case FAULT_FRAME:        return "not while G51 or G68 is in force";
    case FAULT_NO_FACTOR:    return "G51 without P or I J K";
    case FAULT_NO_ANGLE:     return "G68 without R";
    case FAULT_OVAL:         return "arc in a plane that G51 or a rotation does not keep round";
    case FAULT_POLE:         return "polar word without an angle: the tool is at the pole";
    case FAULT_NO_FEED:      return "no F since G93, G94 or G95; with G93 each line needs one";
    case FAULT_REST:         return "G95 with the spindle at rest";
    case FAULT_SURFACE:      return "G95 needs G97: the spindle's speed would change on the way";
    case FAULT_FEED:         return "feed above max_feed [mm/min]";
    case FAULT_SPEED:        return "feed drives an axis above max_rpm [rpm]";
    case FAULT_RANGE:        return "position does not fit the 32-bit pulse counter";
    case FAULT_TRAVEL:       return "path leaves the software limits";
    case FAULT_MISSING:      return "a word is missing that goes with";
    case FAULT_TOOL:         return "no such tool in the tool table";
    case FAULT_NO_INPUTS:    return "this machine has no inputs for";
    case FAULT_NO_PROBE:     return "this machine has no probe for";
    case FAULT_PROBE_POINT:  return "probing leads nowhere";
    case FAULT_NO_MODES:     return "no M70 or M73 in this call before";
    case FAULT_RESTORE:
        return "cutter compensation, G51 or G68 allow no change that this restores";
    case FAULT_NO_TOOL:      return "no T since the tool change before";
    case FAULT_PLANE:        return "plane of U V W, in which this machine has no arcs or cycles";
    case FAULT_CYCLE_R:      return "canned cycle without R";
    case FAULT_CYCLE_DEPTH:  return "canned cycle without its depth";
    case FAULT_CYCLE_Q:      return "canned cycle without Q";
    case FAULT_CYCLE_P:      return "canned cycle without P";
    case FAULT_CYCLE_ASIDE:  return "G87 without I, J and K";
    case FAULT_TAP_K:        return "G33.1 without K, the way of a turn";
    case FAULT_CYCLE_LOW:    return "R is below the bottom of the hole";
    case FAULT_CYCLE_PECKS:  return "more than 10,000 pecks in one hole";
    case FAULT_CYCLE_FEED:   return "canned cycle with G93, in which a feed is that of one motion";
    case FAULT_CYCLE_SPINDLE:return "the spindle does not turn as this cycle needs";
    case FAULT_ROUND_NEXT:
        return ",C and ,R are between two lines or arcs in the plane that follow each other";
    case FAULT_ROUND_SHORT:  return "no room for ,C or ,R between the motions";
    case FAULT_CUTTER_ON:    return "cutter compensation is on already";
    case FAULT_CUTTER_PLANE: return "cutter compensation does not work in this plane";
    case FAULT_CUTTER_WORD:  return "not while cutter compensation is on";
    case FAULT_CUTTER_ENTRY: return "first motion of cutter compensation cannot reach the contour";
    case FAULT_CUTTER_EXIT:  return "motion behind G40 has to be straight";
    case FAULT_CUTTER_ARC:   return "tool does not fit into the arc";
    case FAULT_CUTTER_CORNER:return "tool does not fit into the corner in front of";
    case FAULT_CUTTER_SHORT:
        return "motion too short for the tool to fit into its corners";
    case FAULT_CUTTER_BACK:  return "contour turns back on itself at the start of";
    case FAULT_CUTTER_FULL:  return "too much between two motions of cutter compensation";
    case FAULT_NOTE_COMMENT: return "a comment that does nothing here";
    case FAULT_NOTE_ORIENT:  return "the spindle stops, it has no angle";
    case FAULT_NOTE_SPEED:   return "the spindle has no override";
    case FAULT_NOTE_SPINDLE: return "this machine has no spindle for";
    case FAULT_NOTE_COOLANT: return "this machine has no coolant for";
    case FAULT_NOTE_OVERRIDE:return "overrides act here whatever a program says";
    case FAULT_NOTE_FEED:    return "feed above the highest one of the machine, which it gets";
    case FAULT_NOTE_ANGLE:
        return "this machine has no rotary axes (--angles: A B C in place of U V W) for";
    case FAULT_NOTE_SIDE:
        return "this machine has A B C in place of the axes U V W, so it has none for";
    case FAULT_NOTE_MERGE:   return "runs of short lines stay lines here";
    case FAULT_NOTE_CHECKED: return "lines that repeat are checked up to here";
    case FAULT_COUNT:        break;
    }
    return "";
}
