#include "reconstruct/section/picture_affine.hpp"

namespace biotomy::reconstruct {
namespace {

std::array<double, 4> row_of(const Vector3& direction, double constant) {
  return {direction.x, direction.y, direction.z, constant};
}

}  // namespace

Vector3 PictureAffine::sample_at(double u, double v) const {
  const auto row = [&](std::size_t number) {
    const auto& m = pixel_to_sample[number];
    return m[0] * u + m[1] * v + m[2];
  };
  return {row(0), row(1), row(2)};
}

PicturePosition PictureAffine::picture_at(const Vector3& position) const {
  const auto row = [&](std::size_t number) {
    const auto& m = sample_to_pixel[number];
    return m[0] * position.x + m[1] * position.y + m[2] * position.z + m[3];
  };
  return {row(0), row(1), row(2)};
}

PictureAffine picture_affine(const PixelGrid& grid, const Plane& plane, int left, int top) {
  const Vector3 right = grid.pixel * grid.rectangle.axes.p;
  const Vector3 down = grid.pixel * grid.rectangle.axes.q;
  const Vector3& first = grid.rectangle.origin;
  const Vector3 corner =
      first - static_cast<double>(left) * right - static_cast<double>(top) * down;
  const Vector3 columns = (1.0 / grid.pixel) * grid.rectangle.axes.p;
  const Vector3 rows = (1.0 / grid.pixel) * grid.rectangle.axes.q;
  PictureAffine affine;
  affine.pixel_to_sample = {
      {{right.x, down.x, corner.x}, {right.y, down.y, corner.y}, {right.z, down.z, corner.z}}};
  affine.sample_to_pixel = {row_of(columns, left - dot(columns, first)),
                            row_of(rows, top - dot(rows, first)),
                            row_of(plane.normal(), plane.offset())};
  return affine;
}

}  // namespace biotomy::reconstruct
