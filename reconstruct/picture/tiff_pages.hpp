#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace biotomy::reconstruct {

class TiffFile;

/// Where a page's directory lies in its file, bytes.
using TiffPage = std::uint64_t;

/// Turns to the one picture in the file, past smaller copies of it and masks. Throws SampleError
/// where there is none or more than one.
void go_to_only_picture(const TiffFile& file);

/// Turns to a page that `pages_of_stack` has found. Throws SampleError.
void go_to_page(const TiffFile& file, TiffPage page);

/// The pages of a file whose pages are the layers of a stack, in their order, without smaller
/// copies and masks; one, of a file that holds one picture. Throws SampleError where it can't be
/// read, has no picture, or says that its pages are something else: one colour each (ImageJ's
/// `channels`, OME-XML's SizeC), or the first of images that have no page (ImageJ's stacks of more
/// than 4 GiB).
std::vector<TiffPage> pages_of_stack(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
