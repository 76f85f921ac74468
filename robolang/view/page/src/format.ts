/** A value for a person to read: about three digits. */
export function number(value: number): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size >= 100) return value.toFixed(0);
  if (size >= 10) return value.toFixed(1);
  return size >= 0.095 || size < 5e-5 ? value.toFixed(2) : String(Number(value.toPrecision(2)));
}

/** A value with so many digits after the point; a zero has no sign. */
export function fixed(value: number, digits: number): string {
  return Number.isFinite(value) ? value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1") : "–";
}

export function seconds(value: number, digits = 3): string {
  return `${value.toFixed(digits)} s`;
}
