// Ray records of a Trace on their way to the engine. A ray with a coordinate outside the lattice box
// and all that follow it in the frame are left out.
module gridrt_rays #(
    parameter int unsigned B = 17,
    localparam int unsigned COUNT_W = gridrt_shell_pkg::COUNT_W
) (
    input  logic                                    clk_i,
    input  logic                                    rst_ni,
    input  logic                                    begin_i,  // a new frame
    input  logic                  [2:0][16:0]       box_i,  // largest coordinates
    input  logic                                    record_valid_i,
    output logic                                    record_ready_o,
    input  logic                  [127:0]           record_i,
    output logic                                    issue_o,  // a ray that will be answered
    output logic                  [COUNT_W-1:0]     issued_o,  // rays of this frame so far
    output logic                                    bad_o,  // ray number issued_o is outside the box
    output logic                                    ray_valid_o,
    input  logic                                    ray_ready_i,
    output logic                  [2:0][B-1:0]      ray_p0_o,
    output logic                  [2:0][B-1:0]      ray_p1_o,
    output logic                  [gridrt_pkg::ID_W-1:0] ray_ignore_o,
    output logic                                    ray_any_o
);
  gridrt_protocol_pkg::ray_compact_t ray;
  logic [2:0] outside;
  logic take;

  assign ray = record_i;
  for (genvar a = 0; a < 3; a++) begin : gen_axis
    assign outside[a] = ray.p0[a] > box_i[a] || ray.p1[a] > box_i[a];
  end
  assign record_ready_o = !ray_valid_o || ray_ready_i;
  assign take = record_valid_i && record_ready_o;
  assign issue_o = take && !bad_o && outside == '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      ray_valid_o <= 1'b0;
      bad_o <= 1'b0;
      issued_o <= '0;
    end else begin
      if (issue_o) ray_valid_o <= 1'b1;
      else if (ray_ready_i) ray_valid_o <= 1'b0;
      if (begin_i) begin
        bad_o <= 1'b0;
        issued_o <= '0;
      end else if (take) begin
        bad_o <= bad_o || outside != '0;
        if (issue_o) issued_o <= issued_o + 1'b1;
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (issue_o) begin
      for (int unsigned a = 0; a < 3; a++) begin
        ray_p0_o[a] <= B'(ray.p0[a]);
        ray_p1_o[a] <= B'(ray.p1[a]);
      end
      ray_ignore_o <= ray.ignore;
      ray_any_o <= ray.any_hit;
    end
  end

  logic unused;
  assign unused = &{1'b0, ray.spare};

`ifdef GRIDRT_ASSERT
  logic offered;
  logic [2:0][B-1:0] p0_q;
  always_ff @(posedge clk_i) begin
    offered <= rst_ni && ray_valid_o && !ray_ready_i;
    p0_q <= ray_p0_o;
    if (rst_ni && offered) begin
      assert (ray_valid_o && ray_p0_o == p0_q);
    end
  end
`endif
endmodule
