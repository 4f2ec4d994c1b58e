// EXR files as --reference and `compare` read them. Inputs begin as files that Opal and OpenEXR write.
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "image/image.h"
#include "sweep/reference.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

namespace opal::fuzz {

namespace {

class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : OStream("memory") {}
    void write(const char bytes[], int count) override {
        bytes_.resize(std::max(bytes_.size(), place_ + size_t(count)));
        std::copy_n(bytes, count, bytes_.begin() + std::ptrdiff_t(place_));
        place_ += size_t(count);
    }
    uint64_t tellp() override { return place_; }
    void seekp(uint64_t place) override { place_ = place; }
    const std::string &bytes() const { return bytes_; }

private:
    std::string bytes_;
    size_t place_ = 0;
};

// The file that `render` writes, of few pixels.
std::string opals_file(Random &random) {
    Image image;
    image.width = 1 + int(below(6, random));
    image.height = 1 + int(below(6, random));
    for (const char *name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"})
        if (image.layers.size() < 3 || below(2, random) == 0)
            image.layers.push_back({name, std::vector<float>(size_t(image.width) * size_t(image.height), 0.5f)});
    image.metadata["opal.spp"] = 4;
    image.metadata["opal.seconds"] = 0.25f;
    image.metadata["opal.command"] = "opal a.xml";
    if (below(2, random) == 0)
        image.crop = {1, 2, image.width, image.height, image.width + 8, image.height + 8};
    return exr_bytes(image);
}

// One of other programs: windows apart, parts, half or whole numbers, and names of channels of several layers.
std::string others_file(Random &random) {
    static const std::vector<std::vector<std::string>> channel_names = {
        {"R", "G", "B"},
        {"r", "g", "b"},
        {"Y"},
        {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"},
        {"A", "B", "G", "R", "Z"},
        {"RY", "BY", "Y"},
        {"X"}};
    static const std::vector<std::string> part_names = {"rgb", "beauty", "Combined", "other", "depth"};
    const int width = 1 + int(below(5, random)), height = 1 + int(below(5, random));
    const Imath::Box2i data({int(below(3, random)), int(below(3, random))}, {width + 2, height + 2});
    const Imath::Box2i display({0, 0}, {width + 2 + int(below(2, random)), height + 2});
    std::vector<Imf::Header> headers;
    const size_t parts = 1 + below(3, random);
    for (size_t i = 0; i < parts; i++) {
        Imf::Header header(display, data);
        header.compression() = Imf::Compression(below(Imf::NUM_COMPRESSION_METHODS, random));
        for (const std::string &name : one_of(channel_names, random))
            header.channels().insert(name, Imf::Channel(Imf::PixelType(below(Imf::NUM_PIXELTYPES, random))));
        header.setType(Imf::SCANLINEIMAGE);
        header.setName(part_names[(i + below(3, random)) % part_names.size()] + (i > 0 ? std::to_string(i) : ""));
        headers.push_back(header);
    }
    MemoryOutput stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), int(parts));
        for (int i = 0; i < int(parts); i++) {
            Imf::OutputPart part(file, i);
            part.setFrameBuffer({}); // of channels that are not there, zeros are written
            part.writePixels(data.max.y - data.min.y + 1);
        }
    }
    return stream.bytes();
}

const TextFormat format = {
    .words = [](std::string_view text) { return separated(text, std::string_view("\0", 1)); },
    .replacements = {"R", "Y", "A.Combined.R", "opal.crop", "chlist", "box2i", "string", "float", "int",
                     R"({"x":1,"y":1,"width":2,"height":2,"of_width":9,"of_height":9})", R"({"x":1e99})", "[]", "{}"},
    .piece = '\0',
    .start = [](Random &random) { return below(2, random) == 0 ? opals_file(random) : others_file(random); }};

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("image.exr");
    file.write(input);
    try {
        const Image image = read_exr(file.path());
        require(image.width > 0 && image.height > 0, "an image has pixels");
        for (const Layer &layer : image.layers)
            require(layer.values.size() == size_t(image.width) * size_t(image.height), "a layer has a value a pixel");
        const Crop place = image.place();
        require(place.width == image.width && place.height == image.height, "the crop is the image");
        mean_luminance(image);
        error_against(image, image);
        error_map(image, image);
        text_of(place);
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
