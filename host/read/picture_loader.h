// The pictures of a scene, decoded on other threads while the scene is read on.
#pragma once

#include "read/picture.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace opal {

class PictureLoader {
public:
    PictureLoader() = default;
    PictureLoader(const PictureLoader &) = delete;
    ~PictureLoader();

    // The picture of a file, the same one for each name of the file. Its size and kind are there at once, its values
    // after finish(). Throws Error as PictureFile does. hashes: gets that of the file, once; may be null. on_error: how
    // finish() tells that the values cannot be decoded; one grey pixel then stands for the picture.
    std::shared_ptr<const Picture> load(const std::filesystem::path &file, FileHashes *hashes,
                                        std::function<void(const std::string &)> on_error);

    // The same with its values. Throws Error if they cannot be decoded, too.
    std::shared_ptr<const Picture> load_now(const std::filesystem::path &file, FileHashes *hashes);

    // Has `then` called as soon as all values are there: by finish(), or at once.
    void when_loaded(std::function<void()> then);

    void finish(); // waits for all values. Tells errors and warnings in the order of load()

private:
    struct Job {
        std::optional<PictureFile> file;
        std::filesystem::path name;
        std::shared_ptr<Picture> picture;
        std::function<void(const std::string &)> on_error;
        std::string error{};
        std::size_t invalid = 0;
    };

    void work(bool waits);
    void join();

    std::map<std::filesystem::path, std::shared_ptr<const Picture>> known_; // by canonical path
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    std::vector<std::function<void()>> then_; // when_loaded
    std::size_t next_ = 0;                    // the first job that nobody took
    bool ended_ = false;
    std::vector<std::thread> threads_;
};

} // namespace opal
