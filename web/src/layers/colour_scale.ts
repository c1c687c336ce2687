/**
 * Colours for a value from 0 to 1: from dark blue by grey to yellow. Blue and yellow are told apart
 * with every common kind of colour blindness, and since the lightness grows evenly, in grey too.
 */

export type Rgb = readonly [number, number, number];

const stops: readonly Rgb[] = [
  [9, 28, 82],
  [66, 74, 112],
  [121, 121, 122],
  [181, 172, 106],
  [253, 231, 62],
];

export function scaleColour(part: number): Rgb {
  const place = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const index = Math.min(Math.floor(place), stops.length - 2);
  const from = stops[index] as Rgb;
  const to = stops[index + 1] as Rgb;
  const mixed = (channel: 0 | 1 | 2) =>
    Math.round(from[channel] + (to[channel] - from[channel]) * (place - index));
  return [mixed(0), mixed(1), mixed(2)];
}

export function cssColour([red, green, blue]: Rgb): string {
  return `rgb(${red} ${green} ${blue})`;
}
