#include "image/image.h"

#include "base/error.h"
#include "base/read_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>

namespace opal {

namespace {

// A file in memory, for reading: read_file has seen every error of the disk.
class MemoryInput : public Imf::IStream {
public:
    MemoryInput(const std::filesystem::path &file, std::string bytes)
        : IStream(file.c_str()), bytes_(std::move(bytes)) {}
    bool read(char bytes[], int count) override { // false at the end of the file
        if (place_ > bytes_.size() || static_cast<size_t>(count) > bytes_.size() - place_)
            throw std::runtime_error("the file ends too early");
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(place_), count, bytes);
        place_ += static_cast<size_t>(count);
        return place_ < bytes_.size();
    }
    uint64_t tellg() override { return place_; }
    void seekg(uint64_t place) override { place_ = place; }

private:
    std::string bytes_;
    size_t place_ = 0;
};

// A file in memory, for writing: write_safely then sees every error of the disk.
class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : OStream("memory") {}
    void write(const char bytes[], int count) override {
        const size_t end = place_ + static_cast<size_t>(count);
        if (end > bytes_.size())
            bytes_.resize(end);
        std::copy_n(bytes, count, bytes_.begin() + static_cast<std::ptrdiff_t>(place_));
        place_ = end;
    }
    uint64_t tellp() override { return place_; }
    void seekp(uint64_t place) override { place_ = place; }
    const std::string &bytes() const { return bytes_; }

private:
    std::string bytes_;
    size_t place_ = 0;
};

// OpenEXR's view of a layer's pixels. Its pointer is not const, but writing a file does not change them.
Imf::Slice slice_of(const float *values, int width, const Imath::Box2i &window) {
    char *first = reinterpret_cast<char *>(const_cast<float *>(values));
    const std::ptrdiff_t before = window.min.x + std::ptrdiff_t(window.min.y) * width;
    return Imf::Slice(Imf::FLOAT, first - before * std::ptrdiff_t(sizeof(float)), sizeof(float),
                      sizeof(float) * size_t(width));
}

Image read_pixels(Imf::InputFile &file) {
    const Imf::Header &header = file.header();
    const Imath::Box2i window = header.dataWindow();
    Image image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw Error(fmt::format("channel {} is subsampled, which Opal does not read", channel.name()));
        image.layers.push_back({channel.name(), std::vector<float>(size_t(image.width) * size_t(image.height))});
    }
    Imf::FrameBuffer frame;
    for (Layer &layer : image.layers)
        frame.insert(layer.name, slice_of(layer.values.data(), image.width, window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        if (const auto *text = dynamic_cast<const Imf::StringAttribute *>(&attribute.attribute()))
            image.metadata[attribute.name()] = text->value();
    return image;
}

} // namespace

Image read_exr(const std::filesystem::path &file) {
    MemoryInput stream(file, read_file(file));
    try {
        Imf::InputFile input(stream);
        if (!input.isComplete())
            throw Error("the file is incomplete");
        return read_pixels(input);
    } catch (const std::bad_alloc &) {
        cannot_read(file, ENOMEM);
    } catch (const std::exception &error) {
        throw Error(fmt::format("{}: cannot be read as OpenEXR: {}", file.string(), error.what()));
    }
}

std::string exr_bytes(const Image &image) {
    Imf::Header header(image.width, image.height);
    Imf::FrameBuffer frame;
    for (const Layer &layer : image.layers) {
        if (layer.values.size() != size_t(image.width) * size_t(image.height))
            throw std::logic_error("layer " + layer.name + " is not of the image's size");
        header.channels().insert(layer.name, Imf::Channel(Imf::FLOAT));
        frame.insert(layer.name, slice_of(layer.values.data(), image.width, header.dataWindow()));
    }
    for (const auto &[name, text] : image.metadata)
        header.insert(name, Imf::StringAttribute(text));
    MemoryOutput stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    } // the destructor writes the table of line offsets
    return stream.bytes();
}

void write_exr(const Image &image, const std::filesystem::path &file) { write_safely(file, exr_bytes(image)); }

} // namespace opal
