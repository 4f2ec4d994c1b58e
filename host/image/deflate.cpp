#include "image/deflate.h"

#include <new>
#include <string_view>

namespace opal {

Deflater::Deflater(int strategy, int level) {
    constexpr int most_window_bits = 15, default_memory = 8; // zlib's defaults
    if (deflateInit2(&stream_, level, Z_DEFLATED, most_window_bits, default_memory, strategy) != Z_OK)
        throw std::bad_alloc();
}

Deflater::~Deflater() { deflateEnd(&stream_); }

std::string_view Deflater::operator()(ByteSpan bytes) {
    deflateReset(&stream_);
    out_.resize(deflateBound(&stream_, bytes.size()));
    stream_.next_in = const_cast<unsigned char *>(bytes.data()); // zlib only reads, but its type is not const
    stream_.avail_in = unsigned(bytes.size());
    stream_.next_out = reinterpret_cast<unsigned char *>(out_.data());
    stream_.avail_out = unsigned(out_.size());
    deflate(&stream_, Z_FINISH);
    return {out_.data(), stream_.total_out};
}

bool is_noise(ByteSpan bytes) {
    constexpr double tolerated = 1.02; // growth of the file
    return double(Deflater(Z_RLE, Z_BEST_SPEED)(bytes).size()) <=
           tolerated * double(Deflater(Z_DEFAULT_STRATEGY, Z_BEST_SPEED)(bytes).size());
}

} // namespace opal
