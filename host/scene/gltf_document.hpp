// A glTF file taken apart: its JSON document and the bytes of its buffers.
//
// tinygltf is not used here: its 2.7 takes the default for every optional member of a wrong type
// (a byteOffset of -4, indices "3"), follows image references unchecked, and may read 8 bytes
// beyond a GLB file whose BIN chunk is too long.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "host/scene/json_node.hpp"
#include "host/scene/load.hpp"

namespace gridrt::scene_detail {

/// The parts of a glTF file. Everything throws a Refusal that names the file and the place.
class GltfDocument {
 public:
  /// Takes the container apart (GLB if `binary`) and parses its JSON, but reads no buffer yet.
  /// `bytes`, `file` and `resolve` outlive the document.
  GltfDocument(std::string_view bytes, bool binary, const std::string& file,
               const FileResolver& resolve);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;
  ~GltfDocument();

  JsonNode root() const;
  /// The array of that name at the top of the document; nothing if there is none.
  std::optional<JsonNode> list(const char* name) const { return root().find(name); }
  /// The element of a top-level array that `reference` names by its index.
  JsonNode element(const char* list, const JsonNode& reference) const;
  /// Number of elements of a top-level array.
  std::size_t count(const char* list) const;

  /// The bytes of a buffer view: they exist.
  std::string_view view(const JsonNode& buffer_view);

 private:
  std::string_view buffer(std::size_t index);
  std::string load_uri(const JsonNode& uri) const;

  const std::string& file_;
  const FileResolver& resolve_;
  std::unique_ptr<nlohmann::json> json_;
  std::string_view binary_chunk_;
  bool has_binary_chunk_ = false;
  struct Buffer {
    bool loaded = false;
    std::string owned;
    std::string_view bytes;
  };
  std::vector<Buffer> buffers_;
};

}  // namespace gridrt::scene_detail
