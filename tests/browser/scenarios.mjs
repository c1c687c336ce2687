// What breaks at the rig in these tests; sim/README.md says how it is written.

/** Debris on the face of layer 4 until three photographs were taken: rejected, and taken again. */
export const rejectionsAtLayer4 = `about = "The air nozzle is clogged at layer 4."
[events.nozzle]
fault = "debris_sticks"
when = { grind_finished = 4 }
lasts = { captures = 3 }
`;
