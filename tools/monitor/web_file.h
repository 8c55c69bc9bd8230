#pragma once

#include <cstddef>
#include <string>

struct lws;  // libwebsockets' connection

namespace evit::monitor {

/// A file that is served: name in the URL without '/', content.
struct WebFile {
  std::string name, type, content;
};

/// How far a connection's answer has come. Plain data, which libwebsockets keeps and sets to zero.
struct WebFileTransfer {
  const WebFile* file;  // null: none under way
  std::size_t sent;     // bytes
};

/// Sends the header. The file must outlive the connection. What comes back is for libwebsockets: 0 unless the
/// connection is to be closed.
int BeginTransfer(lws* wsi, const WebFile& file, WebFileTransfer* transfer);
/// The connection takes more: sends the next piece of the content.
int ContinueTransfer(lws* wsi, WebFileTransfer* transfer);

}  // namespace evit::monitor
