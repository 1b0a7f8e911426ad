/* segment - one segment of a smooth path: r(u), 0 <= u <= length, u nearly the length of the way.
 *
 * Lines, arcs and cubics keep their exact geometry and u is their length. A curve is a polynomial
 * of degree 5 in Bernstein's form, so that hulls of its control points and of those of its
 * derivatives bound it exactly. They count from its start: r' and r'' of a curve of micrometres are
 * differences of small numbers, also far from the origin of the coordinates. Segments that follow
 * each other have the same r, r' and r'' where they meet, or the motion rests there.
 */
#ifndef SEGMENT_H
#define SEGMENT_H

#include "command.h"

enum segment_kind { SEGMENT_LINE, SEGMENT_ARC, SEGMENT_CURVE, SEGMENT_CUBIC };

enum { SEGMENT_POINTS = 6 }; /* control points of a curve */

struct segment {
    enum segment_kind kind;
    double length;           /* [mm] range of the parameter u */
    double feed;             /* [mm/s] least programmed feed of the commands in it */
    double cap;              /* [mm/s] highest speed any override may bring */
    struct ramp_limits ramp; /* least limits of the commands in it */
    double share[2];         /* 0..1 of the axes' accelerations that speeding up, slowing down along
                              * it may take; 0: all */
    bool joint;              /* it joins two others at a corner */
    bool even;               /* feed and cap are speeds of u, whatever moves */
    bool rest; /* the motion comes to rest at its end: the next one goes on elsewhere */
    union {
        struct {
            double start[AXES], slope[AXES];
        }; /* line: |slope| is 1 */
        struct {                                  /* curve: */
            double origin[AXES];                  /* [mm] its start */
            double control[SEGMENT_POINTS][AXES]; /* [mm] from its start; the first is 0 */
        };
        struct {
            struct path path;
            double from;
        }; /* arc, cubic: `path` from the length
            * `from` [mm] on */
    };
};

/* Place [mm], r' and r'' [1/mm] at u. */
struct segment_state {
    double point[AXES], slope[AXES], bend[AXES];
};

void segment_at(const struct segment *p, double u, struct segment_state *s);

/* The curve from one state to another over a length: kind, length, origin and control are set. */
void segment_between(struct segment *p, const struct segment_state *a,
                     const struct segment_state *b, double length);

/* Derivatives over a part of a segment: bounds, axis by axis and of their length, and at its
 * ends. */
struct segment_bounds {
    int32_t axes, axis[AXES];             /* number of axes that move, and which; all of the
                                           * others is 0 */
    double low[3][AXES], high[3][AXES];   /* bounds of r', r'' [1/mm], r''' [1/mm^2] */
    double most[3];                       /* bounds of |r'|, |r''|, |r'''| (path.h: in X Y Z;
                                           * without these in U V W) */
    double slope[2][AXES], bend[2][AXES]; /* r' and r'' at both ends */
};

/* Exact bounds or a little outside, between from and to, 0 <= from < to <= length. */
void segment_bounds(const struct segment *p, double from, double to, struct segment_bounds *b);

enum { SEGMENT_DERIVATIVES = 3 };

/* Control values of the derivatives over a part of a curve. */
struct segment_hull {
    int32_t axes, axis[AXES]; /* number of axes that move, and which */
    double control[AXES][SEGMENT_DERIVATIVES][SEGMENT_POINTS - 1];
};

/* What is left of a segment from which parts are cut off one after another. It has the same bounds
 * as by segment_bounds, for less work. */
struct segment_rest {
    const struct segment *segment;
    double from;              /* [mm] where it begins on the segment */
    struct segment_hull hull; /* its control values, if it is a curve */
};

void segment_rest_start(struct segment_rest *r, const struct segment *p);

/* Bounds over all that is left. */
void segment_rest_bounds(const struct segment_rest *r, struct segment_bounds *b);

/* Cut off what lies before `to`: bounds over that. */
void segment_rest_cut(struct segment_rest *r, double to, struct segment_bounds *b);

#endif
