import { boxEdges, facesTowards } from "./cuboid_scene";
import type { CuboidRenderer, CuboidScene } from "./cuboid_scene";
import type { Vector3 } from "./geometry/vector3";
import { projected } from "./orbit_camera";
import { sampleAt } from "./section_record";

/** Draws without WebGL. The projection is parallel, so a section is an affine picture of itself. */
export function canvasRenderer(canvas: HTMLCanvasElement): CuboidRenderer {
  const context = canvas.getContext("2d");
  return {
    draw: (scene, ratio) => context && draw(context, scene, ratio),
    dispose: () => {},
  };
}

function draw(context: CanvasRenderingContext2D, scene: CuboidScene, ratio: number): void {
  const { projection, far, depthPresent, polygon, colours } = scene;
  const place = (point: Vector3) => projected(projection, point);
  const outline = (points: readonly Vector3[]) => {
    context.beginPath();
    for (const point of points) context.lineTo(...place(point));
    context.closePath();
  };
  const stroke = (segments: readonly (readonly [Vector3, Vector3])[], opacity: number) => {
    context.globalAlpha = opacity;
    context.strokeStyle = colours.line;
    context.beginPath();
    for (const [from, to] of segments) {
      context.moveTo(...place(from));
      context.lineTo(...place(to));
    }
    context.stroke();
    context.globalAlpha = 1;
  };
  const { visible, hidden } = boxEdges(far, projection.axes.towards);

  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, projection.width, projection.height);
  context.lineWidth = 1.25;
  stroke(hidden, 0.35);
  if (depthPresent < far[2]) {
    context.globalAlpha = 0.18;
    context.fillStyle = colours.missing;
    for (const face of facesTowards(far, [depthPresent, far[2]], projection.axes.towards)) {
      outline(face);
      context.fill();
    }
    context.globalAlpha = 1;
  }
  context.globalAlpha = 0.35;
  context.fillStyle = colours.plane;
  outline(polygon);
  context.fill();
  context.globalAlpha = 1;
  drawPicture(context, scene, ratio, outline);
  stroke(visible, 0.9);
}

function drawPicture(
  context: CanvasRenderingContext2D,
  { picture, projection }: CuboidScene,
  ratio: number,
  outline: (points: readonly Vector3[]) => void,
): void {
  if (!picture) return;
  const { record, image } = picture;
  const place = (u: number, v: number) => projected(projection, sampleAt(record, u, v));
  const [x, y] = place(-0.5, -0.5);
  const [rightX, rightY] = place(0.5, -0.5);
  const [downX, downY] = place(-0.5, 0.5);
  context.save();
  outline(record.polygon_um);
  context.clip();
  context.setTransform(
    ratio * (rightX - x),
    ratio * (rightY - y),
    ratio * (downX - x),
    ratio * (downY - y),
    ratio * x,
    ratio * y,
  );
  context.drawImage(image, 0, 0);
  context.restore();
}
