/* library_in_use - which part of the large arrays of the motion library, and of the cores that it
 * shares with the robot controller, is in use: rows of fmu_in_use.h for a member of struct
 * model. */
#ifndef LIBRARY_IN_USE_H
#define LIBRARY_IN_USE_H

#include "fmu_in_use.h"

/* For a struct interpreter. */
#define INTERPRETER_IN_USE(in) \
    FMU_RING(in.cutter.held, in.cutter.first, in.cutter.count, 0) \
    FMU_LIST(in.tools.table.tool, in.tools.table.count) \
    FMU_FLAGS(in.parameters.value, PARAMETERS_PAGE, in.parameters.given) \
    FMU_LIST(in.parameters.named, in.parameters.names) \
    FMU_LIST(in.flow.open, in.flow.opens) \
    FMU_LIST(in.flow.call, in.flow.level) \
    FMU_LIST(in.made, in.count)

/* For a struct ring, and for the struct lookahead_mean of a trajectory. */
#define RING_IN_USE(ring) FMU_RING(ring.entry, ring.head, ring.count, 0)
#define MEAN_IN_USE(mean, trajectory) \
    FMU_WHEN(mean, trajectory.motion, TRAJECTORY_CHAIN, TRAJECTORY_CHAIN)

/* For a struct curve_plan, whose shape and speed profile are made when a curve begins. */
#define CURVE_IN_USE(curve, trajectory) \
    FMU_WHEN(curve.shape, trajectory.motion, TRAJECTORY_CURVE, TRAJECTORY_CURVE) \
    FMU_WHEN(curve.shape.run.vertex, curve.shape.running, 1, 1) \
    FMU_LIST(curve.shape.run.vertex, curve.shape.run.vertices) \
    FMU_BETWEEN(curve.shape.segment, curve.shape.gone, curve.shape.made, 0) \
    FMU_BETWEEN(curve.shape.mark, curve.shape.marks_gone, curve.shape.marks, 0) \
    FMU_WHEN(curve.profile, trajectory.motion, TRAJECTORY_CURVE, TRAJECTORY_CURVE) \
    FMU_RING(curve.profile.ring, curve.profile.at.head, curve.profile.count, SPEED_PROFILE_KEPT) \
    FMU_TO_END(curve.profile.plan[0].node, curve.profile.plan[0].first) \
    FMU_TO_END(curve.profile.plan[1].node, curve.profile.plan[1].first)

/* For a struct joint_flow, whose speed profile is made when the first move begins. */
#define JOINT_FLOW_IN_USE(flow) \
    FMU_WHEN(flow.profile, flow.made, 1, INT32_MAX) \
    FMU_RING(flow.profile.ring, flow.profile.at.head, flow.profile.count, 0) \
    FMU_TO_END(flow.profile.plan[0].node, flow.profile.plan[0].first) \
    FMU_TO_END(flow.profile.plan[1].node, flow.profile.plan[1].first) \
    FMU_BETWEEN(flow.piece, flow.at, flow.made, 0)

/* For a struct mcc. */
#define MCC_IN_USE(mcc) \
    FMU_LIST(mcc.tools.tool, mcc.tools.count) \
    INTERPRETER_IN_USE(mcc.program) \
    FMU_LIST(mcc.mdi.text, mcc.mdi.length) \
    RING_IN_USE(mcc.ring) \
    MEAN_IN_USE(mcc.mean, mcc.trajectory) \
    CURVE_IN_USE(mcc.curve_plan, mcc.trajectory) \
    FMU_RING(mcc.queue.item, mcc.queue.head, mcc.queue.count, 0)

/* For a struct voltage. */
#define VOLTAGE_IN_USE(voltage) \
    FMU_BETWEEN(voltage.commanded_path.point, voltage.commanded_path.first, \
                voltage.commanded_path.frames, 1)

#endif
