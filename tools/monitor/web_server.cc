#include "tools/monitor/web_server.h"

#include <libwebsockets.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace evit::monitor {
namespace {

static_assert(Frame::kHead >= LWS_PRE);
constexpr std::size_t kLongestMessage = 64 << 10;  // bytes, from a client
constexpr unsigned kWriteBuffer = 1 << 20;         // bytes
constexpr int kRounds = 16;                        // of frames at a time: the bus must not wait for long
constexpr char kHttp[] = "http";

std::string Header(lws* wsi, lws_token_indexes token) {
  char text[512];
  const int n = lws_hdr_copy(wsi, text, sizeof text, token);
  return n > 0 ? std::string(text, static_cast<std::size_t>(n)) : "";
}

bool Has(lws* wsi, lws_token_indexes token) { return lws_hdr_total_length(wsi, token) > 0; }

}  // namespace

struct WebServer::Implementation {
  struct Client {
    ClientId id = 0;
    lws* wsi = nullptr;
    std::string message;  // received so far
  };
  // What libwebsockets keeps for a connection.
  struct Session {
    Client* client;
    WebFileTransfer transfer;
  };

  Implementation(const Options& o, std::vector<WebFile> f, WebClients* c)
      : options(o), policy(o.bind, o.origins), files(std::move(f)), handler(c) {}

  static int Callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  int OnRequest(lws* wsi, Session* session, std::string_view path);
  bool MayConnect(lws* wsi) const;
  int OnReceive(lws* wsi, Client* client, std::string_view part);
  int Send(lws* wsi, Client* client);
  void Close(Client* client);

  Options options;
  OriginPolicy policy;
  std::vector<WebFile> files;
  WebClients* handler;
  std::vector<lws_protocols> protocols;
  lws_context* context = nullptr;
  std::map<ClientId, std::unique_ptr<Client>> clients;
  ClientId next_id = 1;
  int frames_sent = 0;  // since it last looked
};

bool WebServer::Implementation::MayConnect(lws* wsi) const {
  if (static_cast<int>(clients.size()) >= options.max_clients) return false;
  const std::string origin = Header(wsi, WSI_TOKEN_ORIGIN);
  if (Has(wsi, WSI_TOKEN_ORIGIN) && origin.empty()) return false;  // too long to be one of ours
  return policy.Allows(origin, Header(wsi, WSI_TOKEN_HOST));
}

int WebServer::Implementation::OnRequest(lws* wsi, Session* session, std::string_view path) {
  if (!policy.AllowsHost(Header(wsi, WSI_TOKEN_HOST))) {
    lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, nullptr);
    return -1;
  }
  if (!path.empty()) path.remove_prefix(1);
  const auto file =
      std::find_if(files.begin(), files.end(), [&](const WebFile& known) { return known.name == path; });
  if (file == files.end() || !Has(wsi, WSI_TOKEN_GET_URI)) {
    lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND, nullptr);
    return -1;
  }
  return BeginTransfer(wsi, *file, &session->transfer);
}

int WebServer::Implementation::OnReceive(lws* wsi, Client* client, std::string_view part) {
  if (client->message.size() + part.size() > kLongestMessage) return -1;
  client->message += part;
  if (lws_is_final_fragment(wsi) == 0 || lws_remaining_packet_payload(wsi) != 0) return 0;
  const std::string whole = std::exchange(client->message, {});
  handler->Received(client->id, whole);
  return 0;
}

int WebServer::Implementation::Send(lws* wsi, Client* client) {
  const FramePtr frame = handler->Next(client->id);
  if (!frame) return 0;
  // libwebsockets writes its header into the room in front of the data, each time the same.
  auto* const data = const_cast<std::uint8_t*>(frame->data());
  if (lws_write(wsi, data, frame->size(), frame->is_text() ? LWS_WRITE_TEXT : LWS_WRITE_BINARY) < 0) {
    return -1;
  }
  ++frames_sent;
  lws_callback_on_writable(wsi);
  return 0;
}

void WebServer::Implementation::Close(Client* client) {
  const ClientId id = client->id;
  clients.erase(id);
  handler->Closed(id);
}

int WebServer::Implementation::Callback(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                                        std::size_t size) {
  lws_context* const context = lws_get_context(wsi);
  auto* const self = context == nullptr ? nullptr : static_cast<Implementation*>(lws_context_user(context));
  auto* const session = static_cast<Session*>(user);
  const std::string_view text(static_cast<const char*>(in), in == nullptr ? 0 : size);
  if (self == nullptr) return lws_callback_http_dummy(wsi, reason, user, in, size);  // not set up yet
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return self->OnRequest(wsi, session, text);
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return ContinueTransfer(wsi, &session->transfer);
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION: {
      const bool known = std::string_view(lws_get_protocol(wsi)->name) != kHttp;
      return known && self->MayConnect(wsi) ? 0 : -1;
    }
    case LWS_CALLBACK_ESTABLISHED: {
      auto client = std::make_unique<Client>();
      client->id = self->next_id++;
      client->wsi = wsi;
      session->client = client.get();
      const ClientId id = client->id;
      self->clients.emplace(id, std::move(client));
      self->handler->Connected(id, lws_get_protocol(wsi)->name);
      return 0;
    }
    case LWS_CALLBACK_RECEIVE:
      return self->OnReceive(wsi, session->client, text);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return self->Send(wsi, session->client);
    case LWS_CALLBACK_CLOSED:
      if (session->client != nullptr) self->Close(std::exchange(session->client, nullptr));
      return 0;
    default:
      return lws_callback_http_dummy(wsi, reason, user, in, size);
  }
}

WebServer::WebServer(const Options& options, std::vector<WebFile> files, WebClients* clients)
    : implementation_(std::make_unique<Implementation>(options, std::move(files), clients)) {
  Implementation& self = *implementation_;
  lws_set_log_level(0, nullptr);  // what matters is said by exceptions
  const auto add = [&](const char* name) {
    lws_protocols protocol{};
    protocol.name = name;
    protocol.callback = &Implementation::Callback;
    protocol.per_session_data_size = sizeof(Implementation::Session);
    self.protocols.push_back(protocol);
  };
  add(kHttp);
  for (const std::string& name : self.options.protocols) add(name.c_str());
  self.protocols.push_back(lws_protocols{});

  lws_context_creation_info info{};
  info.port = options.port;
  if (options.bind != "0.0.0.0") info.iface = self.options.bind.c_str();
  info.protocols = self.protocols.data();
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  info.user = implementation_.get();
  info.options = LWS_SERVER_OPTION_DISABLE_IPV6 | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  // So many bytes are written at a time; of the default, 4 kB, a picture would take a second of looks.
  info.pt_serv_buf_size = kWriteBuffer;
  // A viewer whose host has vanished is let go after some minutes.
  info.ka_time = 60;
  info.ka_probes = 4;
  info.ka_interval = 15;
  self.context = lws_create_context(&info);
  if (self.context == nullptr || port() <= 0) {
    if (self.context != nullptr) lws_context_destroy(std::exchange(self.context, nullptr));
    throw std::runtime_error("cannot listen on " + options.bind + ":" + std::to_string(options.port) +
                             ": is another program, or another monitor, using the port? Choose one with "
                             "--port, and with --bind an address of this host");
  }
}

WebServer::~WebServer() {
  if (implementation_->context != nullptr) lws_context_destroy(implementation_->context);
}

int WebServer::port() const {
  lws_vhost* const host = lws_get_vhost_by_name(implementation_->context, "default");
  return host == nullptr ? -1 : lws_get_vhost_listen_port(host);
}

void WebServer::Service() {
  // As long as viewers take frames; a negative time: look once, wait for nothing.
  for (int i = 0; i < kRounds; ++i) {
    implementation_->frames_sent = 0;
    lws_service(implementation_->context, -1);
    if (implementation_->frames_sent == 0) break;
  }
}

bool WebServer::busy() const { return implementation_->frames_sent > 0; }

void WebServer::Wake(ClientId client) {
  const auto found = implementation_->clients.find(client);
  if (found != implementation_->clients.end()) lws_callback_on_writable(found->second->wsi);
}

}  // namespace evit::monitor
