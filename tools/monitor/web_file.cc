#include "tools/monitor/web_file.h"

#include <libwebsockets.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace evit::monitor {
namespace {

constexpr std::size_t kChunk = 32 << 10;  // bytes at a time

}  // namespace

int BeginTransfer(lws* wsi, const WebFile& file, WebFileTransfer* transfer) {
  std::uint8_t buffer[LWS_PRE + 2048];
  std::uint8_t *at = buffer + LWS_PRE, *const end = buffer + sizeof buffer - 1;
  // style: plots size their elements themselves.
  const std::pair<const char*, std::string> headers[] = {
      {"content-security-policy:",
       "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'; "
       "base-uri 'none'; form-action 'none'"},
      {"x-content-type-options:", "nosniff"},
      {"cache-control:", "no-cache"}};
  bool ok =
      lws_add_http_common_headers(wsi, HTTP_STATUS_OK, file.type.c_str(), file.content.size(), &at, end) == 0;
  for (const auto& [name, value] : headers) {
    ok = ok && lws_add_http_header_by_name(wsi, reinterpret_cast<const std::uint8_t*>(name),
                                           reinterpret_cast<const std::uint8_t*>(value.data()),
                                           static_cast<int>(value.size()), &at, end) == 0;
  }
  if (!ok || lws_finalize_write_http_header(wsi, buffer + LWS_PRE, &at, end) != 0) return 1;
  transfer->file = &file;
  transfer->sent = 0;
  lws_callback_on_writable(wsi);
  return 0;
}

int ContinueTransfer(lws* wsi, WebFileTransfer* transfer) {
  if (transfer->file == nullptr) return 0;
  const std::string& content = transfer->file->content;
  const std::size_t n = std::min(kChunk, content.size() - transfer->sent);
  const bool last = transfer->sent + n == content.size();
  std::vector<std::uint8_t> buffer(LWS_PRE + n);
  std::copy_n(content.begin() + static_cast<std::ptrdiff_t>(transfer->sent), n, buffer.begin() + LWS_PRE);
  if (lws_write(wsi, buffer.data() + LWS_PRE, n, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0) return -1;
  transfer->sent += n;
  if (!last) {
    lws_callback_on_writable(wsi);
    return 0;
  }
  transfer->file = nullptr;
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

}  // namespace evit::monitor
