#pragma once

namespace biotomy::acquisition {

/// Makes the threads that help in loops of TBB's and OpenCV's, all of them, with the priority of
/// the caller, and waits for them for a second at most. Otherwise they are made when one is needed
/// first, and keep the priority of whoever that was: of a thread that draws pictures, for instance,
/// and the judging of frames would be left to helpers that make way for everybody. The caller's
/// thread keeps them.
void start_helping_threads();

}  // namespace biotomy::acquisition
