#include "reconstruct/picture/jpeg_library.hpp"

#include <jerror.h>

namespace biotomy::reconstruct {
namespace {

JpegReport& report_of(j_common_ptr codec) {
  return *reinterpret_cast<JpegReport*>(codec->err);
}

void keep_message(j_common_ptr codec) {
  JpegReport& report = report_of(codec);
  if (report.text[0] == '\0') {
    (*codec->err->format_message)(codec, report.text.data());
  }
}

void fail(j_common_ptr codec) {
  keep_message(codec);
  std::longjmp(report_of(codec).place, 1);
}

void hear(j_common_ptr codec, int level) {
  const bool is_unheard =
      codec->err->msg_code == JWRN_EXTRANEOUS_DATA && !report_of(codec).hears_of_extraneous_bytes;
  if (level < 0 && !is_unheard) {  // a warning: the data is corrupt; the others are traces
    keep_message(codec);
    ++codec->err->num_warnings;
  }
}

}  // namespace

JpegReport::JpegReport() {
  jpeg_std_error(&manager);
  manager.error_exit = fail;
  manager.emit_message = hear;
  manager.output_message = [](j_common_ptr) {};
}

}  // namespace biotomy::reconstruct
