// Folders inside a run's folder.
#pragma once

#include <filesystem>

namespace astroid {

/// Makes a folder and those above it; nothing happens when it is there. @throws EnvironmentError(path, cause)
void create_folder(const std::filesystem::path& folder);

}  // namespace astroid
