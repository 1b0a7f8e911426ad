/* Pieces of a line become one box where that costs nothing, and stay two where it would be slow. */
#include "speed_line.h"

int main(void)
{
    at_rest();
    piece(0.0, 40.0, 50.0);
    piece(40.0, 70.0, 50.0);
    piece(70.0, LENGTH, 50.0);
    CHECK_EQ(profile.count, 1);
    CHECK_NEAR(profile.end, LENGTH, 1e-12);

    at_rest();
    piece(0.0, 40.0, 50.0);
    piece(40.0, LENGTH, 10.0);
    CHECK_EQ(profile.count, 2);

    /* Less than a nanometre has no box of its own. */
    at_rest();
    piece(0.0, 1e-7, 48.0);
    piece(1e-7, LENGTH, 50.0);
    CHECK_EQ(profile.count, 1);
    return check_result();
}
