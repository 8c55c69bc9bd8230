#pragma once

#include <cstdint>
#include <string>

/// Small files, written whole or not at all. All throw std::runtime_error naming the file.
namespace evit::paper {

std::string ReadText(const std::string& path);
void WriteText(const std::string& path, const std::string& text);
void MakeFolder(const std::string& path);

/// FNV-1a over 64 bits: tells whether something has changed, no more.
std::uint64_t HashOf(const std::string& text);
std::uint64_t HashOfFile(const std::string& path);
std::string HexText(std::uint64_t hash);

}  // namespace evit::paper
