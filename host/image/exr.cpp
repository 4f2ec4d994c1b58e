#include "image/image.h"

#include "base/error.h"
#include "base/json.h"
#include "base/large_vector.h"
#include "base/log.h"
#include "base/read_file.h"
#include "base/srgb.h"
#include "image/deflate.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <ImfXdr.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <future>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>

namespace opal {

namespace {

// A file in memory, for reading: read_file has seen every error of the disk.
class MemoryInput : public Imf::IStream {
public:
    MemoryInput(const std::filesystem::path &file, std::string_view bytes) : IStream(file.c_str()), bytes_(bytes) {}
    bool read(char bytes[], int count) override { // false at the end of the file
        if (place_ > bytes_.size() || static_cast<size_t>(count) > bytes_.size() - place_)
            throw std::runtime_error("the file ends too early");
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(place_), count, bytes);
        place_ += static_cast<size_t>(count);
        // A whole number behind a text is the size of an attribute, for which OpenEXR makes room before it reads on, or
        // the type of a channel's pixels, 0 to 2.
        int32_t number = 0;
        if (text_ended_ && count == sizeof number)
            std::memcpy(&number, bytes, sizeof number);
        if (number > 2 && static_cast<size_t>(number) > bytes_.size() - place_)
            throw std::runtime_error("an attribute is larger than the file");
        text_ended_ = count == 1 && bytes[0] == '\0';
        return place_ < bytes_.size();
    }
    uint64_t tellg() override { return place_; }
    void seekg(uint64_t place) override { place_ = place; }

private:
    std::string_view bytes_;
    size_t place_ = 0;
    bool text_ended_ = false; // by the byte that was read last
};

// The head of a file in memory, for writing.
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
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    size_t place_ = 0;
};

// OpenEXR's view of a channel's pixels. stride: floats from one pixel to the next
Imf::Slice slice_of(float *values, int width, const Imath::Box2i &window, size_t stride = 1) {
    char *first = reinterpret_cast<char *>(values);
    const std::ptrdiff_t before = window.min.x + std::ptrdiff_t(window.min.y) * width;
    return Imf::Slice(Imf::FLOAT, first - before * std::ptrdiff_t(stride * sizeof(float)), stride * sizeof(float),
                      stride * sizeof(float) * size_t(width));
}

constexpr std::array channel_names = {"R", "G", "B"};
constexpr const char *crop_attribute = "opal.crop";

bool has_rgb(const Imf::Header &header, const std::string &layer = "") {
    return std::ranges::all_of(
        channel_names, [&](const char *name) { return header.channels().findChannel(layer + name) != nullptr; });
}

// The part that holds the picture.
int picture_part(const Imf::MultiPartInputFile &file) {
    const auto named = [&](const char *name) -> std::optional<int> {
        for (int part = 0; part < file.parts(); part++)
            if (file.header(part).hasName() && file.header(part).name() == name)
                return part;
        return {};
    };
    for (const char *name : {"rgb", "beauty", "Combined"})
        if (const auto part = named(name))
            return *part;
    for (int part = 0; part < file.parts(); part++)
        if (has_rgb(file.header(part)))
            return part;
    return 0;
}

// The channels that are the picture, in their order: R, G, B or what stands for them; X, Y, Z; Y alone. None: no such
// channels.
std::vector<std::string> picture_channels(const std::vector<std::string> &names) {
    const auto has = [&](const std::string &name) { return std::ranges::find(names, name) != names.end(); };
    std::vector<std::vector<std::string>> choices = {{"R", "G", "B"}, {"r", "g", "b"}};
    for (const std::string &name : names)
        if (name.ends_with(".Combined.R")) {
            const std::string stem = name.substr(0, name.size() - 1);
            choices.push_back({stem + "R", stem + "G", stem + "B"});
        }
    choices.push_back({"X", "Y", "Z"});
    if (!has("RY")) // beside it, Y is luminance to chroma
        choices.push_back({"Y"});
    for (const std::vector<std::string> &choice : choices)
        if (std::ranges::all_of(choice, has))
            return choice;
    return {};
}

// Makes R, G, B of the channels X, Y, Z: CIE XYZ with white D65, linear sRGB (IEC 61966-2-1).
void to_linear_srgb(Image &image) {
    std::array<Layer, 3> layers = {image.get("X"), image.get("Y"), image.get("Z")};
    std::erase_if(image.layers, [](const Layer &l) { return l.name == "X" || l.name == "Y" || l.name == "Z"; });
    for (size_t i = 0; i < layers[0].values.size(); i++) {
        const Color rgb = linear_rgb_of_xyz(layers[0].values[i], layers[1].values[i], layers[2].values[i]);
        for (size_t c = 0; c < rgb.size(); c++)
            layers[c].values[i] = float(rgb[c]);
    }
    for (size_t c = 0; c < channel_names.size(); c++)
        image.layers.push_back({channel_names[c], std::move(layers[c].values)});
}

// Gives the picture's channels the names R, G, B, where it has others.
void name_channels(const std::filesystem::path &file, Image &image) {
    if (image.find("R"))
        return;
    std::vector<std::string> names;
    for (const Layer &layer : image.layers)
        names.push_back(layer.name);
    const std::vector<std::string> from = picture_channels(names);
    if (from.empty())
        return;
    if (from.front() == "X") {
        to_linear_srgb(image);
        note(fmt::format("{}: takes the channels X, Y, Z, as linear sRGB", file.string()));
    } else if (from.front() == "Y") {
        const std::vector<float> values = image.get("Y").values;
        std::erase_if(image.layers, [](const Layer &layer) { return layer.name == "Y"; });
        for (const char *name : channel_names)
            image.layers.push_back({name, values});
        image.is_luminance = true;
        note(fmt::format("{}: takes the channel Y for R, G and B", file.string()));
    } else {
        for (size_t c = 0; c < from.size(); c++)
            for (Layer &layer : image.layers)
                if (layer.name == from[c])
                    layer.name = channel_names[c];
        note(fmt::format("{}: takes the channels {} for R, G, B", file.string(), fmt::join(from, ", ")));
    }
}

// The place that the file states: by opal.crop, or by a data window that is not the display window.
Crop stated_crop(const Imf::Header &header, const Image &image) {
    if (const std::string text = image.text(crop_attribute); !text.empty()) {
        const nlohmann::json j = parse_json(text);
        const Crop crop{j.at("x"), j.at("y"), j.at("width"), j.at("height"), j.at("of_width"), j.at("of_height")};
        if (crop.width != image.width || crop.height != image.height)
            throw Error(fmt::format("its attribute {} is not of the image's size: {}", crop_attribute, text));
        return crop;
    }
    const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
    if (data == display)
        return {};
    return {data.min.x - display.min.x,        data.min.y - display.min.y,       image.width, image.height,
            display.max.x - display.min.x + 1, display.max.y - display.min.y + 1};
}

void read_attributes(const Imf::Header &header, Image &image) {
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const Imf::Attribute *value = &attribute.attribute();
        if (const auto *text = dynamic_cast<const Imf::StringAttribute *>(value))
            image.metadata[attribute.name()] = text->value();
        else if (const auto *whole = dynamic_cast<const Imf::IntAttribute *>(value))
            image.metadata[attribute.name()] = whole->value();
        else if (const auto *number = dynamic_cast<const Imf::FloatAttribute *>(value))
            image.metadata[attribute.name()] = number->value();
    }
}

// Throws where so small a file cannot hold so large an image: memory for it, and for OpenEXR's buffers of up to 256
// lines, would be taken before its end is seen.
void check_size(const Imf::Header &header, size_t file_size) {
    constexpr double most_lines = 256, least_limit = 128e6; // bytes
    constexpr double most_compression = 65536;              // DWAB makes 1 byte of 28856 of black lines of 8192 pixels
    const Imath::Box2i window = header.dataWindow();
    double bytes_a_pixel = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytes_a_pixel += sizeof(float);
    const double width = double(window.max.x) - window.min.x + 1, height = double(window.max.y) - window.min.y + 1;
    if (width * std::max(height, most_lines) * bytes_a_pixel >
        std::max(least_limit, most_compression * double(file_size)))
        throw Error(fmt::format("{} bytes cannot hold {} x {} pixels", file_size, width, height));
}

std::vector<std::string> names_of(const Imf::ChannelList &channels) {
    std::vector<std::string> names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names.push_back(channel.name());
    return names;
}

void refuse_subsampled(const std::string &name, const Imf::Channel &channel) {
    if (channel.xSampling != 1 || channel.ySampling != 1)
        throw Error(fmt::format("channel {} is subsampled, which Opal does not read", name));
}

// Those of a picture; else the only channel there is.
std::vector<std::string> texture_channels(const Imf::ChannelList &channels) {
    const std::vector<std::string> all = names_of(channels);
    std::vector<std::string> names = picture_channels(all);
    if (names.empty() && all.size() == 1)
        names = all;
    if (names.empty())
        throw Error(fmt::format("it has no channels R, G, B; it has {}", fmt::join(all, ", ")));
    for (const std::string &name : names)
        refuse_subsampled(name, channels[name.c_str()]);
    return names;
}

ExrTexture size_of(const Imf::Header &header, size_t channels) {
    const Imath::Box2i window = header.dataWindow();
    return {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, int(channels), {}};
}

void note_part(const std::filesystem::path &file, const Imf::MultiPartInputFile &input, int part) {
    if (input.parts() > 1)
        note(fmt::format("{}: has {} parts; takes {}", file.string(), input.parts(),
                         input.header(part).hasName() ? input.header(part).name() : "the first"));
}

// Calls use(input, part) with the part that holds the picture, once it is checked.
template <class Use> auto with_exr(const std::filesystem::path &file, std::string_view bytes, Use use) {
    MemoryInput stream(file, bytes);
    try {
        Imf::MultiPartInputFile input(stream);
        const int part = picture_part(input);
        if (input.header(part).hasType() && Imf::isDeepData(input.header(part).type()))
            throw Error("it is deep: several samples a pixel, which Opal does not read");
        if (!input.partComplete(part))
            throw Error("the file is incomplete");
        check_size(input.header(part), bytes.size());
        return use(input, part);
    } catch (const std::bad_alloc &) {
        cannot_read(file, ENOMEM);
    } catch (const std::exception &error) {
        throw Error(fmt::format("{}: cannot be read as OpenEXR: {}", file.string(), error.what()));
    }
}

Image read_pixels(Imf::MultiPartInputFile &parts, int part) {
    Imf::InputPart file(parts, part);
    const Imf::Header &header = file.header();
    const Imath::Box2i window = header.dataWindow();
    Image image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        refuse_subsampled(channel.name(), channel.channel());
        image.layers.push_back({channel.name(), std::vector<float>(size_t(image.width) * size_t(image.height))});
    }
    Imf::FrameBuffer frame;
    for (Layer &layer : image.layers)
        frame.insert(layer.name, slice_of(layer.values.data(), image.width, window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    read_attributes(header, image);
    image.crop = stated_crop(header, image);
    image.metadata.erase(crop_attribute); // Image::crop has it
    return image;
}

Imf::Header header_of(const Image &image) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities()); // the default: Rec. 709 with white D65
    header.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
    header.insert("software", Imf::StringAttribute("Opal " OPAL_VERSION));
    for (const auto &[name, value] : image.metadata)
        if (const auto *text = std::get_if<std::string>(&value))
            header.insert(name, Imf::StringAttribute(*text));
        else if (const auto *whole = std::get_if<int>(&value))
            header.insert(name, Imf::IntAttribute(*whole));
        else
            header.insert(name, Imf::FloatAttribute(std::get<float>(value)));
    if (const Crop &crop = image.crop; crop != Crop{})
        header.insert(crop_attribute, Imf::StringAttribute(dump(json_of(crop))));
    for (const Layer &layer : image.layers) {
        if (layer.name.size() > 1 && std::string("abgry").find(char(std::tolower(layer.name[0]))) != std::string::npos)
            throw std::logic_error("layer " + layer.name + " begins with a letter that readers take for a channel");
        if (layer.values.size() != size_t(image.width) * size_t(image.height))
            throw std::logic_error("layer " + layer.name + " is not of the image's size");
        header.channels().insert(layer.name, Imf::Channel(Imf::FLOAT));
    }
    return header;
}

// The file's layout is written here, and OpenEXR writes the header alone: it compresses by zlib's search for
// repetitions, which takes half the time of writing and finds none in noise.

bool has_long_names(const Imf::Header &header) {
    constexpr size_t short_name = 32; // bytes, the zero included
    bool found = false;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        found = found || std::strlen(attribute.name()) >= short_name;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        found = found || std::strlen(channel.name()) >= short_name;
    return found;
}

template <class Number> void append_bytes(std::string &bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char *>(&number), sizeof number);
}

// A chunk is a scanline: its y and the size of its bytes, 32 bits each, then those bytes.
constexpr size_t chunk_head = 2 * sizeof(int32_t);
size_t chunk_size(const std::string &block, size_t at) {
    int32_t bytes;
    std::memcpy(&bytes, block.data() + at + sizeof(int32_t), sizeof bytes);
    return chunk_head + size_t(bytes);
}

// Makes chunks of scanlines by ZIPS.
class ZipsChunks {
public:
    // channels: the pixels of each, in the order of the header's channels
    ZipsChunks(const std::vector<const float *> &channels, size_t width)
        : channels_(channels), width_(width), line_(width * channels.size()), halves_(2 * 2 * line_.size()),
          differences_(halves_.size()) {}

    // The chunks of the scanlines [first, end).
    std::string operator()(size_t first, size_t end) {
        std::string chunks;
        for (size_t y = first; y < end; y++) {
            arrange(y);
            if (y == first)
                noise_ = is_noise(differences_);
            std::string_view packed = (noise_ ? for_noise_ : for_repetitions_)(differences_);
            if (packed.size() >= differences_.size())
                packed = {reinterpret_cast<const char *>(line_.data()), differences_.size()}; // stored as it is
            append_bytes(chunks, int32_t(y));
            append_bytes(chunks, int32_t(packed.size()));
            chunks += packed;
        }
        return chunks;
    }

private:
    // Writes scanline y's floats, channel after channel, and what ZIPS compresses: their even bytes, then the odd ones,
    // each as its difference from the one before.
    void arrange(size_t y) {
        for (size_t c = 0; c < channels_.size(); c++)
            std::copy_n(channels_[c] + y * width_, width_, line_.begin() + std::ptrdiff_t(c * width_));
        const size_t half = 2 * line_.size();
        for (size_t i = 0; i < line_.size(); i++) {
            const auto bits = std::bit_cast<uint32_t>(line_[i]);
            halves_[2 * i] = static_cast<unsigned char>(bits);
            halves_[2 * i + 1] = static_cast<unsigned char>(bits >> 16);
            halves_[half + 2 * i] = static_cast<unsigned char>(bits >> 8);
            halves_[half + 2 * i + 1] = static_cast<unsigned char>(bits >> 24);
        }
        differences_[0] = halves_[0];
        for (size_t i = 1; i < halves_.size(); i++)
            differences_[i] = static_cast<unsigned char>(halves_[i] - halves_[i - 1] + 128);
    }

    static constexpr int level = 4; // for repetitions, as OpenEXR has it

    const std::vector<const float *> &channels_;
    const size_t width_;
    std::vector<float> line_;
    std::vector<unsigned char> halves_, differences_;
    bool noise_ = false;
    Deflater for_noise_{Z_RLE, Z_BEST_SPEED}, for_repetitions_{Z_DEFAULT_STRATEGY, level};
};

// The chunks of all scanlines, from the top down in blocks of several, made on all cores.
std::vector<std::string> zips_blocks(const Image &image, const Imf::Header &header) {
    constexpr size_t lines = 32; // of a block
    std::vector<const float *> channels;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        channels.push_back(image.get(channel.name()).values.data());
    const size_t width = size_t(image.width), height = size_t(image.height);
    std::vector<std::string> blocks((height + lines - 1) / lines);
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        ZipsChunks chunks(channels, width);
        for (size_t i = next++; i < blocks.size(); i = next++)
            blocks[i] = chunks(i * lines, std::min(height, (i + 1) * lines));
    };
    std::vector<std::future<void>> others;
    try {
        for (size_t i = 1; i < std::min<size_t>(blocks.size(), std::thread::hardware_concurrency()); i++)
            others.push_back(std::async(std::launch::async, work));
    } catch (const std::system_error &) { // a limit on threads: those that there are do the work
    }
    work();
    for (std::future<void> &other : others)
        other.get();
    return blocks;
}

} // namespace

Image read_exr(const std::filesystem::path &file, FileHashes *hashes) {
    const std::string bytes = read_file(file);
    if (hashes)
        hashes->add(bytes);
    return with_exr(file, bytes, [&](Imf::MultiPartInputFile &input, int part) {
        Image image = read_pixels(input, part);
        note_part(file, input, part);
        name_channels(file, image);
        return image;
    });
}

ExrTexture exr_size(const std::filesystem::path &file, std::string_view bytes) {
    return with_exr(file, bytes, [&](Imf::MultiPartInputFile &input, int part) {
        const Imf::Header &header = input.header(part);
        const std::vector<std::string> all = names_of(header.channels());
        const std::vector<std::string> channels = texture_channels(header.channels());
        note_part(file, input, part);
        if (channels.size() != all.size() || (channels.front() != "R" && channels.front() != "Y"))
            note(fmt::format("{}: takes {} of the channels {}", file.string(), fmt::join(channels, ", "),
                             fmt::join(all, ", ")));
        if (header.dataWindow() != header.displayWindow())
            note(fmt::format("{}: takes the data window, which is not the display window", file.string()));
        return size_of(header, channels.size());
    });
}

ExrTexture exr_pixels(const std::filesystem::path &file, std::string_view bytes) {
    return with_exr(file, bytes, [&](Imf::MultiPartInputFile &input, int part) {
        Imf::InputPart own(input, part);
        const Imath::Box2i window = own.header().dataWindow();
        const std::vector<std::string> channels = texture_channels(own.header().channels());
        ExrTexture pixels = size_of(own.header(), channels.size());
        const size_t values = channels.size() * size_t(pixels.width) * size_t(pixels.height);
        pixels.values.resize(values);
        Imf::FrameBuffer frame;
        for (size_t c = 0; c < channels.size(); c++)
            frame.insert(channels[c], slice_of(pixels.values.data() + c, pixels.width, window, channels.size()));
        own.setFrameBuffer(frame);
        own.readPixels(window.min.y, window.max.y);
        if (channels.front() == "X")
            for (size_t i = 0; i < values; i += channels.size()) {
                float *const pixel = &pixels.values[i];
                const Color rgb = linear_rgb_of_xyz(pixel[0], pixel[1], pixel[2]);
                std::copy(rgb.begin(), rgb.end(), pixel);
            }
        return pixels;
    });
}

nlohmann::json json_of(const Crop &crop) {
    return object({{"x", crop.x},
                   {"y", crop.y},
                   {"width", crop.width},
                   {"height", crop.height},
                   {"of_width", crop.of_width},
                   {"of_height", crop.of_height}});
}

void check_exr_size(int width, size_t layers) {
    // A chunk, here a line, tells its size in bytes as an int.
    const size_t most = size_t(std::numeric_limits<int>::max()) / (sizeof(float) * layers);
    if (size_t(width) > most)
        throw Error(fmt::format("an EXR of {} layers holds at most {} pixels a line, and the image has {}", layers,
                                most, width));
}

std::string exr_bytes(const Image &image) {
    const Imf::Header header = header_of(image);
    header.sanityCheck();
    MemoryOutput start;
    Imf::Xdr::write<Imf::StreamIO>(start, Imf::MAGIC);
    Imf::Xdr::write<Imf::StreamIO>(start, Imf::EXR_VERSION | (has_long_names(header) ? Imf::LONG_NAMES_FLAG : 0));
    header.writeTo(start);
    std::string bytes = start.take();
    std::vector<std::string> blocks = zips_blocks(image, header);
    size_t size = bytes.size() + sizeof(uint64_t) * size_t(image.height);
    for (const std::string &block : blocks)
        size += block.size();
    bytes.reserve(size);
    uint64_t place = bytes.size() + sizeof(uint64_t) * size_t(image.height);
    for (const std::string &block : blocks) // the table of the chunks' places
        for (size_t at = 0; at < block.size(); at += chunk_size(block, at)) {
            append_bytes(bytes, place);
            place += chunk_size(block, at);
        }
    for (std::string &block : blocks) {
        bytes += block;
        free_memory(block);
    }
    return bytes;
}

void write_exr(const Image &image, const std::filesystem::path &file) { write_safely(file, exr_bytes(image)); }

} // namespace opal
