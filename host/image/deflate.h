// Compression of images' bytes by zlib's deflate, at little cost for noise.
#pragma once

#include <span>
#include <string>

#include <zlib.h>

namespace opal {

using ByteSpan = std::span<const unsigned char>;

// Deflates buffers of bytes, each by itself, in zlib's format. strategy, level: as zlib's deflateInit2 takes them.
class Deflater {
public:
    Deflater(int strategy, int level);
    ~Deflater();
    Deflater(const Deflater &) = delete;
    Deflater &operator=(const Deflater &) = delete;

    // The compressed bytes, valid until the next call.
    std::string_view operator()(ByteSpan bytes);

private:
    z_stream stream_{};
    std::string out_;
};

// Is Z_RLE, which looks for no repetition but that of the last byte, as good on these bytes as looking for all? It is
// on noise, where it takes half the time.
bool is_noise(ByteSpan bytes);

} // namespace opal
