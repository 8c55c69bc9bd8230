#include "common/bus/message_assembler.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/bus/limits.h"

namespace evit {
namespace {

constexpr std::uint32_t kShort = 0x4c433032, kFragment = 0x4c433033;  // LC02, LC03
constexpr std::size_t kShortHeader = 8, kFragmentHeader = 20;
constexpr std::size_t kMaxChannelName = 63;  // LCM's own limit

std::uint32_t Get(const std::uint8_t* at, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | at[i];
  return value;
}

// The channel's name at `at`; empty where there is none that ends in time.
std::string_view NameAt(const std::uint8_t* at, std::size_t size) {
  const auto* const end =
      static_cast<const std::uint8_t*>(std::memchr(at, 0, std::min(size, kMaxChannelName + 1)));
  if (end == nullptr) return {};
  return {reinterpret_cast<const char*>(at), static_cast<std::size_t>(end - at)};
}

}  // namespace

bool MessageAssembler::Add(std::uint64_t sender, const std::uint8_t* datagram, std::size_t size,
                           Message* message) {
  if (size < kShortHeader) return false;
  const std::uint32_t magic = Get(datagram, 4);
  if (magic == kFragment) return AddFragment(sender, datagram, size, message);
  if (magic != kShort) return false;
  const std::string_view channel = NameAt(datagram + kShortHeader, size - kShortHeader);
  if (channel.empty()) return false;
  const std::size_t begin = kShortHeader + channel.size() + 1;
  *message = {channel, datagram + begin, size - begin, false};
  return true;
}

MessageAssembler::Assembly* MessageAssembler::Begin(std::uint64_t sender, std::uint32_t number,
                                                    std::size_t size, std::size_t n_fragments,
                                                    std::string_view channel) {
  Assembly assembly;
  std::swap(assembly, done_);
  if (assemblies_.size() == kMaxSenders) assemblies_.erase(assemblies_.begin());
  assembly.sender = sender;
  assembly.number = number;
  assembly.size = size;
  assembly.remaining = n_fragments;
  assembly.channel = channel;
  assembly.has.assign(n_fragments, false);
  if (assembly.memory.size() < size) assembly.memory.resize(size);
  assemblies_.push_back(std::move(assembly));
  return &assemblies_.back();
}

bool MessageAssembler::AddFragment(std::uint64_t sender, const std::uint8_t* datagram, std::size_t size,
                                   Message* message) {
  if (size < kFragmentHeader) return false;
  const std::uint32_t number = Get(datagram + 4, 4);
  const std::size_t whole = Get(datagram + 8, 4), offset = Get(datagram + 12, 4);
  const std::size_t fragment = Get(datagram + 16, 2), n_fragments = Get(datagram + 18, 2);
  if (whole > kMaxMessageBytes || fragment >= n_fragments) return false;
  const std::uint8_t* data = datagram + kFragmentHeader;
  std::size_t n = size - kFragmentHeader;

  auto found = std::find_if(assemblies_.begin(), assemblies_.end(),
                            [sender](const Assembly& a) { return a.sender == sender; });
  if (found != assemblies_.end() &&
      (found->number != number || found->size != whole || found->has.size() != n_fragments)) {
    assemblies_.erase(found);  // the rest of that message is lost
    found = assemblies_.end();
  }
  Assembly* assembly = found == assemblies_.end() ? nullptr : &*found;
  if (fragment == 0) {
    const std::string_view channel = NameAt(data, n);
    if (channel.empty()) return false;
    data += channel.size() + 1;
    n -= channel.size() + 1;
    if (assembly == nullptr) assembly = Begin(sender, number, whole, n_fragments, channel);
  }
  if (assembly == nullptr || offset > whole || n > whole - offset || assembly->has[fragment]) return false;
  std::memcpy(assembly->memory.data() + offset, data, n);
  assembly->has[fragment] = true;
  if (--assembly->remaining > 0) return false;
  std::swap(done_, *assembly);
  assemblies_.erase(assemblies_.begin() + (assembly - assemblies_.data()));
  *message = {done_.channel, done_.memory.data(), whole, true};
  return true;
}

}  // namespace evit
