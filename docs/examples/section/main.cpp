// Cuts a sample along the plane through three points, in micrometres, into a PNG:
//
//   section knee "4995,0,1580 0,4995,1580 9990,0,790" section.png
//
// What is wrong is told by exceptions: InvalidRequest for what can never work (three points on a
// line), SampleError for what does not fit this sample (a plane that misses it).

#include <exception>
#include <iostream>

#include "reconstruct/bricks/opened_sample.hpp"
#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"

namespace rc = biotomy::reconstruct;

namespace {

void cut(const char* folder, const char* points, const char* picture) {
  // While the sample is being ground, its newest layers are not in the volume yet: they are its
  // tail.
  const rc::OpenedSample sample(folder);
  sample.require_layers();

  // Plane::through_points takes the points as numbers; here they come as text.
  rc::PlaneText text;
  text.points = points;
  const rc::Plane plane =
      rc::parse_plane("", text, rc::LengthUnit::micrometres, sample.volume.cuboid().spacing);

  rc::SectionStyle style;
  style.theta = rc::theta::Inscribed{};  // no background in the picture
  const rc::SectionBasis basis = rc::section_basis(rc::BasisKind::layer, plane);

  // Decoded chunks are kept for the next section; 256 MB of them here.
  rc::VolumeBricks source(sample.volume, 256'000'000, {}, &sample.tail);
  const rc::Section section = rc::cut_section(source, {plane, basis, style});

  const rc::PixelGrid& grid = section.outline.grid;
  rc::write_section_image(picture, section.image, rc::PictureNotes{grid.pixel, "", ""});

  // Where the picture is: pixel (u, v) lies at origin + u·pixel·p + v·pixel·q.
  const rc::Vector3& origin = grid.rectangle.origin;
  std::cout << grid.columns << " x " << grid.rows << " pixels of " << grid.pixel
            << " um, the first at " << origin.x << ',' << origin.y << ',' << origin.z << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: section SAMPLE \"x,y,z x,y,z x,y,z\" PICTURE\n";
    return 2;
  }
  try {
    cut(argv[1], argv[2], argv[3]);
  } catch (const rc::InvalidRequest& error) {
    std::cerr << "section: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "section: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
