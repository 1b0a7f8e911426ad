/* freertos_scheme - tokens of the scheme of the network card's tasks (task_scheme.h), recorded from
 * the FreeRTOS kernel V11.1.0. */
#ifndef FREERTOS_SCHEME_H
#define FREERTOS_SCHEME_H

static const struct {
    const char *scenario, *tokens;
} RECORDED[] = {
    { "home_during_run",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !home >parse >home 5>2 h4 h"
      "5 h6 h7 h8 h9 2>5 >run r10 r11 r12 r13 r14 r15 r16 r17 r18 r19 r20 r21 r22 r23 r24 r"
      "25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41 r42 r43 r44 r45 r"
      "46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "home_during_pause",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !pause >parse >pause p4 p5 "
      "!home >parse >home 5>2 >pause p6 p7 p8 p9 p10 p11 p12 p13 p14 p15 p16 p17 p18 p19 p2"
      "0 p21 p22 p23 p24 p25 p26 p27 p28 p29 p30 p31 p32 p33 p34 p35 p36 p37 p38 p39 p40 p4"
      "1 p42 p43 p44 p45 p46 >home h47 h48 h49 h50 h51 h52 2>5 >run r53 r54 r55 r56 r57 r58"
      " r59 r60 " },
    { "start_twice_then_stop",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !run >parse >run r4 r5 r6 !"
      "stop >parse >stop s7 >run r8 r9 r10 r11 r12 r13 r14 r15 r16 r17 r18 r19 r20 r21 r22 "
      "r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41 r42 r43 "
      "r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "pause_while_idle",
      ">parse >home >stop >pause >run !stop >parse >stop s1 !pause >parse >pause p2 p3 p4 p"
      "5 " },
    { "two_starts_while_homing",
      ">parse >home >stop >pause >run !home >parse >home 5>2 h1 h2 !run >parse >home h3 h4 "
      "!run >parse >home h5 h6 h7 h8 2>5 >run r9 r10 r11 r12 r13 " },
    { "two_starts_during_the_job",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 !run >parse >run r3 !run >pars"
      "e >run r4 r5 r6 r7 r8 r9 r10 " },
    { "three_homes",
      ">parse >home >stop >pause >run !home >parse >home 5>2 h1 h2 !home >parse >home h3 h4"
      " !home >parse >home h5 h6 2>5 5>2 h7 h8 h9 h10 h11 h12 2>5 " },
    { "two_homes_while_paused",
      ">parse >home >stop >pause >run !pause >parse >pause p1 p2 !stop >parse >stop s3 >pau"
      "se p4 !home >parse >home 5>2 >pause p5 !home >parse >pause p6 p7 p8 p9 >home h10 h11"
      " h12 2>5 5>2 h13 h14 h15 2>5 " },
    { "two_pauses_while_stopping",
      ">parse >home >stop >pause >run !stop >parse >stop !pause >parse >stop !pause >parse "
      ">stop s1 >pause p2 p3 " },
    { "start_and_stop_while_homing",
      ">parse >home >stop >pause >run !home >parse >home 5>2 h1 h2 !run >parse >home h3 h4 "
      "!stop >parse >stop s5 >home h6 !run >parse >home h7 h8 h9 2>5 >run r10 r11 r12 r13 r"
      "14 " },
    { "stop_during_home",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !home >parse >home 5>2 h4 h"
      "5 !stop >parse >stop s6 >home h7 h8 h9 h10 2>5 >run r11 r12 r13 r14 r15 r16 r17 r18 "
      "r19 r20 r21 r22 r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 "
      "r40 r41 r42 r43 r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "pause_during_home",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !home >parse >home 5>2 h4 h"
      "5 !pause >parse >pause p6 p7 p8 >home h9 h10 h11 h12 2>5 >run r13 r14 r15 r16 r17 r1"
      "8 r19 r20 r21 r22 r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r3"
      "9 r40 r41 r42 r43 r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r6"
      "0 " },
    { "pause_and_stop_at_once",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !pause !stop >parse >stop s"
      "4 >pause p5 >run r6 r7 r8 r9 r10 r11 r12 r13 r14 r15 r16 r17 r18 r19 r20 r21 r22 r23"
      " r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41 r42 r43 r44"
      " r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "stop_and_home_at_once",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !stop !home >parse >home 5>"
      "2 >stop s4 >home h5 h6 h7 h8 h9 h10 2>5 >run r11 r12 r13 r14 r15 r16 r17 r18 r19 r20"
      " r21 r22 r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41"
      " r42 r43 r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "four_starts",
      ">parse >home >stop >pause >run !run >parse >run r1 !run >parse >run r2 !run >parse >"
      "run r3 !run >parse >run r4 r5 r6 r7 r8 r9 r10 " },
    { "two_pauses",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !pause >parse >pause p4 p5 "
      "!pause >parse >pause p6 p7 p8 p9 >run r10 r11 r12 r13 r14 r15 r16 r17 r18 r19 r20 r2"
      "1 r22 r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41 r4"
      "2 r43 r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
    { "home_as_urgent_as_run",
      ">parse >home >stop >pause >run !run >parse >run r1 r2 r3 !home >parse >home 5>1 h4 >"
      "run r5 r6 r7 r8 r9 >home h10 h11 h12 h13 h14 1>5 >run r15 r16 r17 r18 r19 r20 r21 r2"
      "2 r23 r24 r25 r26 r27 r28 r29 r30 r31 r32 r33 r34 r35 r36 r37 r38 r39 r40 r41 r42 r4"
      "3 r44 r45 r46 r47 r48 r49 r50 r51 r52 r53 r54 r55 r56 r57 r58 r59 r60 " },
};

#endif
