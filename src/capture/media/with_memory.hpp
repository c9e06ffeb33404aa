#pragma once
// FFmpeg's calls, told from what fails for want of memory.

#include <cerrno>
#include <new>

namespace wisp {

/// Makes one of FFmpeg's calls and returns its code. Throws std::bad_alloc where the code, or errno, says that an
/// allocation failed in it: the file is not at fault, and leaving frames out would change what is measured. (FFmpeg's
/// H.264 decoder returns success where an allocation for a picture failed; malloc reports it in errno.) Every call that
/// may read or decode goes through it, the last, empty packet's too. errno belongs to the calling thread: what fails in
/// decoding threads is only seen where FFmpeg returns it.
template <class Call, class... Arguments>
int with_memory(Call call, Arguments... arguments) {
  errno = 0;  // encoders and malloc leave there what they got over
  const int code = call(arguments...);
  if (code == -ENOMEM || errno == ENOMEM) throw std::bad_alloc();
  return code;
}

}  // namespace wisp
