#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace biotomy::reconstruct {

/// Writes `bytes` so that after a crash at any moment the name holds the old content or the new,
/// whole: a temporary file in the same folder, fsync, rename, fsync of the folder.
/// Throws SampleError, with the temporary file removed.
void write_durably(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_durably(const std::filesystem::path& path, const std::string& text);

/// A file of several parts, one after the other, that need not be put together in memory.
using FileParts = std::vector<std::vector<std::byte>>;
void write_durably(const std::filesystem::path& path, const FileParts& parts);

/// As write_durably, without the last step: after a crash the name may hold the old content until
/// sync_folder was called. For many files of one folder, which are then synced together.
void write_before_folder_sync(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// As write_durably, and what the disk gives back is compared before the file gets its name, so
/// that the old content is lost only to a good copy of the new. Returns the SHA-256.
std::string write_durably_verified(const std::filesystem::path& path,
                                   std::span<const std::byte> bytes);

/// Whether this is a file that a process was writing durably when it was ended by force: it has the
/// name of such a file, and no process of that number lives but this one.
bool is_unfinished_write(const std::filesystem::path& path);

/// Removes the unfinished writes below a folder, at any depth. Nothing of this process may be
/// under way there. What cannot be removed stays: it is hidden and does no harm.
void remove_unfinished_writes(const std::filesystem::path& folder);

/// Makes a folder and those above it, so that they are still there after a crash. Several threads
/// may make the same one. Throws SampleError.
void create_folders_durably(const std::filesystem::path& folder);

/// fsyncs a folder: what was created or renamed in it stays.
void sync_folder(const std::filesystem::path& folder);

/// Lower-case hexadecimal SHA-256.
std::string sha256(std::span<const std::byte> bytes);
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
