// Timeouts of tests. On a slow machine toolchain/ctest sets ADIT_PATIENCE, which multiplies all timeouts.
const text = process.env.ADIT_PATIENCE ?? "1", factor = Number(text);
if (!(factor >= 1 && factor < Infinity)) throw new Error(`ADIT_PATIENCE: expected a number of at least 1, not '${text}'`);

/** `timeout` times ADIT_PATIENCE. */
export const patient = (timeout) => timeout * factor;
