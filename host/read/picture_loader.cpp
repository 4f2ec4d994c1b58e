#include "read/picture_loader.h"

#include "base/error.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace opal {

PictureLoader::~PictureLoader() {
    {
        const std::lock_guard lock(mutex_);
        next_ = jobs_.size();
    }
    join();
}

void PictureLoader::join() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
    for (std::thread &thread : threads_)
        thread.join();
    threads_.clear();
}

// Decodes until there is no job. waits: goes on with those to come, until the end.
void PictureLoader::work(bool waits) {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (waits)
            changed_.wait(lock, [&] { return next_ < jobs_.size() || ended_; });
        if (next_ == jobs_.size())
            return;
        Job &job = jobs_[next_++]; // a deque's elements stay where they are
        lock.unlock();
        try {
            *job.picture = job.file->decode(job.invalid);
        } catch (const std::exception &error) {
            job.error = error.what();
        }
        job.file.reset();
        lock.lock();
    }
}

std::shared_ptr<const Picture> PictureLoader::load(const std::filesystem::path &file, FileHashes *hashes,
                                                   std::function<void(const std::string &)> on_error) {
    std::error_code failed;
    const std::filesystem::path path = std::filesystem::canonical(file, failed);
    std::shared_ptr<const Picture> &known = known_[failed ? file : path];
    if (known)
        return known;
    PictureFile opened(file, hashes);
    const auto picture = std::make_shared<Picture>(opened.header());
    constexpr double worth_a_thread = 1 << 20; // values: some milliseconds
    const bool is_large = double(picture->width) * picture->height * picture->channels > worth_a_thread;
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back({std::move(opened), file, picture, std::move(on_error)});
    }
    changed_.notify_one();
    if (is_large && threads_.size() < std::max(1u, std::thread::hardware_concurrency())) {
        try {
            threads_.emplace_back([this] { work(true); });
        } catch (const std::system_error &) { // a limit on threads: finish() does the work
        }
    }
    return known = picture;
}

std::shared_ptr<const Picture> PictureLoader::load_now(const std::filesystem::path &file, FileHashes *hashes) {
    std::string error;
    std::shared_ptr<const Picture> picture = load(file, hashes, [&](const std::string &message) { error = message; });
    finish();
    if (!error.empty())
        throw Error(error);
    return picture;
}

void PictureLoader::when_loaded(std::function<void()> then) {
    if (jobs_.empty())
        then();
    else
        then_.push_back(std::move(then));
}

void PictureLoader::finish() {
    work(false);
    join();
    for (Job &job : jobs_) {
        if (!job.error.empty()) {
            *job.picture = {1, 1, 1, {}, {0.5f}};
            std::erase_if(known_, [&](const auto &known) { return known.second == job.picture; });
            job.on_error(job.error);
        }
        warn_of_invalid(job.name, job.invalid);
    }
    jobs_.clear();
    next_ = 0;
    ended_ = false;
    for (const auto &then : std::exchange(then_, {}))
        then();
}

} // namespace opal
