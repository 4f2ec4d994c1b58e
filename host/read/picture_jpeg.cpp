// Pictures from JPEG files, baseline and progressive, by libjpeg-turbo.
#include "read/picture_formats.h"

#include <cstdio> // jpeglib.h needs FILE
#include <stdexcept>
#include <string>

#include <jpeglib.h>

#include <jerror.h>

namespace opal {
namespace {

[[noreturn]] void throw_message(j_common_ptr jpeg) {
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    throw std::runtime_error(text);
}

// libjpeg warns of damage and goes on with grey. Where no pixel is lost there is nothing to tell.
void take_message(j_common_ptr jpeg, int level) {
    if (level >= 0) // no warning
        return;
    switch (jpeg->err->msg_code) {
    case JWRN_ADOBE_XFORM:
    case JWRN_BOGUS_ICC:
    case JWRN_EXTRANEOUS_DATA:
    case JWRN_JFIF_MAJOR:
        return;
    case JWRN_JPEG_EOF:
        throw std::runtime_error("the file ends early");
    default:
        throw_message(jpeg);
    }
}

// A scan of a few bytes goes through the whole image: the number that libjpeg-turbo's own fuzzers stop at.
void check_scans(j_common_ptr jpeg) {
    constexpr int most_scans = 500;
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > most_scans)
        throw std::runtime_error("it has more than 500 scans");
}

// libjpeg's state of a file whose header is read.
struct Reading {
    explicit Reading(std::string_view bytes) {
        jpeg.err = jpeg_std_error(&errors);
        errors.error_exit = throw_message;
        errors.emit_message = take_message;
        jpeg_create_decompress(&jpeg);
        progress.progress_monitor = check_scans;
        jpeg.progress = &progress;
        jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
    }
    Reading(const Reading &) = delete;
    ~Reading() { jpeg_destroy_decompress(&jpeg); }

    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};
};

} // namespace

PictureHeader jpeg_header(const std::filesystem::path &, std::string_view bytes) {
    Reading reading(bytes);
    jpeg_decompress_struct &jpeg = reading.jpeg;
    jpeg_read_header(&jpeg, TRUE);
    if (jpeg.num_components == 4)
        throw std::runtime_error("it holds CMYK, for printing; convert it to RGB");
    if (jpeg.num_components != 1 && jpeg.num_components != 3)
        throw std::runtime_error("it has neither one nor three channels");
    if (jpeg.arith_code)
        throw std::runtime_error("it is compressed by arithmetic coding, which Opal does not read");
    PictureHeader header{};
    Picture &picture = header.picture;
    picture.width = int(jpeg.image_width);
    picture.height = int(jpeg.image_height);
    picture.channels = jpeg.num_components;
    picture.encoded = true;
    double blocks = 0; // of 8 x 8 values
    for (int i = 0; i < jpeg.num_components; i++)
        blocks += double(jpeg.comp_info[i].width_in_blocks) * jpeg.comp_info[i].height_in_blocks;
    constexpr double least_bits = 1; // of a block, by Huffman's codes
    header.file_bytes = blocks * least_bits / 8;
    header.memory_bytes = double(picture.width) * picture.height * picture.channels;
    if (jpeg_has_multiple_scans(&jpeg)) // all coefficients stay until the last scan
        header.memory_bytes += blocks * sizeof(JBLOCK);
    return header;
}

void decode_jpeg(std::string_view bytes, Picture &picture) {
    Reading reading(bytes);
    jpeg_decompress_struct &jpeg = reading.jpeg;
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = picture.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&jpeg);
    const size_t row = size_t(picture.width) * size_t(picture.channels);
    picture.bytes.resize(row * size_t(picture.height));
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW to = picture.bytes.data() + size_t(jpeg.output_scanline) * row;
        jpeg_read_scanlines(&jpeg, &to, 1);
    }
}

} // namespace opal
