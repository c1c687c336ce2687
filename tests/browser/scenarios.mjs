// What breaks at the rig in these tests; sim/README.md says how it is written.

/** Too little light on the face of layer 4 until two photographs were taken: rejected, taken again. */
export const rejectionsAtLayer4 = `about = "The lamp has a loose contact at layer 4."
[events.lamp]
fault = "lamp_dims"
share = 0.6
when = { grind_finished = 4 }
lasts = { captures = 2 }
`;
