// The lock of a sweep's folder: only one sweep at a time writes there.
#pragma once

#include <filesystem>

namespace opal {

// Holds flock(2) on a file in the folder. The kernel lifts it when this process and those that it forked have ended,
// however they end. Throws Error if another process holds it; warns where the file system knows no locks.
class FolderLock {
public:
    explicit FolderLock(const std::filesystem::path &folder);
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;
    FolderLock &operator=(const FolderLock &) = delete;

private:
    int file_ = -1;
};

} // namespace opal
