/* links - kinematics of two links in a plane. Joints in degrees, the second counted from the first
 * link; the elbow stays on its side. */
#ifndef LINKS_H
#define LINKS_H

#include "mechanism.h"

struct links {
    double upper, fore;
}; /* [mm] */

struct kinematics links_kinematics(void);

#endif
