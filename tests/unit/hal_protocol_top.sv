// Elaborates the protocol package: a place that is not as the C++ records say stops the linter.
module hal_protocol_top
  import gridrt_protocol_pkg::*;
(
    input  ray_compact_t ray,
    output hit_compact_t hit
);
  if ($bits(ray_compact_t) != 8 * RAY_COMPACT_BYTES) $error("ray_compact_t");
  if ($bits(hit_compact_t) != 8 * HIT_COMPACT_BYTES) $error("hit_compact_t");
  if ($bits(ray_wide_t) != 256 || $bits(hit_wide_t) != 64) $error("wide records");
  if ($bits(frame_header_t) != 8 * FRAME_HEADER_BYTES) $error("frame_header_t");
  if ($bits(image_header_t) != 8 * 144) $error("image_header_t");
  if ($bits(section_entry_t) != 128) $error("section_entry_t");
  if ($bits(block_record_t) != 40 || BLOCK_RECORD_BITS != 39) $error("block_record_t");
  if ($bits(vertex_record_t) != 56 || VERTEX_RECORD_BITS != 54) $error("vertex_record_t");
  if (RAY_COMPACT_P1_BIT != 51 || RAY_COMPACT_IGNORE_BIT != 102) $error("ray_compact_t places");

  // Field names and bit numbers lead to the same bits.
  localparam ray_compact_t Probe = 128'h8421_0842_1084_2108_4210_8421_0842_1084;
  if (Probe.p0[0] != Probe[RAY_COMPACT_P0_BIT+:RAY_COMPACT_P0_WIDTH]) $error("p0");
  if (Probe.p1[0] != Probe[RAY_COMPACT_P1_BIT+:RAY_COMPACT_P1_WIDTH]) $error("p1");
  if (Probe.ignore != Probe[RAY_COMPACT_IGNORE_BIT+:RAY_COMPACT_IGNORE_WIDTH]) $error("ignore");
  if (Probe.any_hit != Probe[RAY_COMPACT_ANY_HIT_BIT]) $error("any_hit");

  assign hit = '{
          id: ray.ignore ^ {3'b0, ray.p0[0] ^ ray.p0[1] ^ ray.p0[2]},
          hit: ray.any_hit,
          uncertain: ^ray.p1,
          spare: {5'b0, ray.spare}
      };
endmodule
