import {
  BufferGeometry,
  DoubleSide,
  Float32BufferAttribute,
  LinearFilter,
  LinearMipmapLinearFilter,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  Scene,
  SRGBColorSpace,
  Texture,
  Vector3 as ThreeVector3,
  WebGLRenderer,
} from "three";

import { boxEdges, facesTowards, texturedPolygon } from "./cuboid_scene";
import type { CuboidRenderer, CuboidScene } from "./cuboid_scene";
import { norm, scale, subtract } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import type { SectionPicture } from "./section_record";

/** Throws where the browser has no WebGL after all. */
export function webglRenderer(canvas: HTMLCanvasElement): CuboidRenderer {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
  const scene = new Scene();
  const camera = new OrthographicCamera();
  const visible = lines(0.9);
  const hidden = lines(0.35);
  const missing = surface(0.18);
  const plane = surface(0.35);
  const section = surface(1);
  const texture = new SectionTexture(section.material);
  // What is seen through is drawn over what is not; edges last.
  [section, plane, missing, hidden, visible].forEach((part, order) => {
    part.renderOrder = order;
    part.frustumCulled = false;
    scene.add(part);
  });

  return {
    draw(wanted, ratio) {
      const { projection, far, depthPresent, polygon, picture, colours } = wanted;
      // Numbers of about 1: single precision is enough for them.
      const unit = norm(far);
      const placed = (points: readonly Vector3[]) =>
        points.map((point) => scale(1 / unit, subtract(point, projection.middle)));
      const edges = boxEdges(far, projection.axes.towards);
      setPoints(visible.geometry, placed(edges.visible.flat()));
      setPoints(hidden.geometry, placed(edges.hidden.flat()));
      const below: [number, number] = [depthPresent, far[2]];
      const faces = depthPresent < far[2] ? facesTowards(far, below, projection.axes.towards) : [];
      setPoints(missing.geometry, placed(faces.flatMap(fan)));
      setPoints(plane.geometry, placed(fan(polygon)));
      const textured = picture ? texturedPolygon(picture) : [];
      setPoints(section.geometry, placed(fan(textured.map(({ point }) => point))));
      section.geometry.setAttribute(
        "uv",
        new Float32BufferAttribute(
          fan(textured).flatMap(({ u, v }) => [u, v]),
          2,
        ),
      );
      texture.show(picture);
      visible.material.color.set(colours.line);
      hidden.material.color.set(colours.line);
      missing.material.color.set(colours.missing);
      plane.material.color.set(colours.plane);
      look(camera, wanted, unit);
      renderer.setPixelRatio(ratio);
      renderer.setSize(projection.width, projection.height, false);
      renderer.render(scene, camera);
    },
    dispose() {
      for (const part of [visible, hidden, missing, plane, section]) {
        part.geometry.dispose();
        part.material.dispose();
      }
      texture.dispose();
      renderer.dispose();
    },
  };
}

const lines = (opacity: number) =>
  new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ transparent: true, opacity, depthWrite: false }),
  );

const surface = (opacity: number) =>
  new Mesh(
    new BufferGeometry(),
    new MeshBasicMaterial({
      side: DoubleSide,
      transparent: opacity < 1,
      opacity,
      depthWrite: opacity === 1,
      // The plane itself lies behind its picture.
      polygonOffset: opacity < 1,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    }),
  );

function setPoints(geometry: BufferGeometry, points: readonly Vector3[]): void {
  geometry.setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
}

/** Triangles of a convex polygon. */
const fan = <T>(points: readonly T[]): T[] =>
  points.slice(2).flatMap((point, i) => [points[0], points[i + 1], point]);

function look(camera: OrthographicCamera, { projection }: CuboidScene, unit: number): void {
  const { axes, width, height, scale: pixels } = projection;
  camera.left = -width / 2 / (pixels * unit);
  camera.right = -camera.left;
  camera.top = height / 2 / (pixels * unit);
  camera.bottom = -camera.top;
  camera.near = 0;
  camera.far = 4;
  camera.position.set(...scale(2, axes.towards));
  camera.up.set(...axes.up);
  camera.lookAt(new ThreeVector3(0, 0, 0));
  camera.updateProjectionMatrix();
}

/** The picture of the section on the graphics card; sent there when it is another one. */
class SectionTexture {
  private texture: Texture | null = null;
  private shown: ImageBitmap | null = null;

  constructor(private readonly material: MeshBasicMaterial) {
    material.visible = false;
  }

  show(picture: SectionPicture | null): void {
    const image = picture?.image ?? null;
    if (image === this.shown) return;
    this.dispose();
    this.shown = image;
    this.material.visible = image !== null;
    if (image) {
      this.texture = new Texture(image);
      this.texture.flipY = false; // bitmaps stay as they are
      this.texture.colorSpace = SRGBColorSpace;
      this.texture.magFilter = LinearFilter;
      this.texture.minFilter = LinearMipmapLinearFilter;
      this.texture.needsUpdate = true;
    }
    this.material.map = this.texture;
    this.material.needsUpdate = true;
  }

  dispose(): void {
    this.texture?.dispose();
    this.texture = null;
    this.shown = null;
  }
}
