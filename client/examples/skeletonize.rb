#!/usr/bin/ruby
# frozen_string_literal: true

# Sends a mask in a .npy file to a bccskel server and counts the ends and loops of its skeleton: a
# client in Ruby, from the .proto files alone. On Debian: ruby-grpc protobuf-compiler
# protobuf-compiler-grpc; the stubs are made by
#
#   mkdir -p stubs && protoc -I proto --ruby_out=stubs --grpc_out=stubs \
#       --plugin=protoc-gen-grpc="$(command -v grpc_ruby_plugin)" proto/bccskel/v1/*.proto
#   ruby -I stubs client/examples/skeletonize.rb mask.npy 127.0.0.1:50051
#
# The array is mask[z, y, x] of bytes or booleans: voxels that are not 0 belong to the object.

require 'digest'
require 'grpc'
require 'bccskel/v1/rpc_details_pb'
require 'bccskel/v1/skeletonization_service_services_pb'

V1 = Bccskel::V1
CHUNK_BYTES = 1 << 19

# The sides [nz, ny, nx] of the array and its bytes.
def read_npy(path)
  data = File.binread(path)
  raise "#{path}: is no .npy file" unless data.start_with?("\x93NUMPY".b)

  at, size = data.getbyte(6) == 1 ? [10, data[8, 2].unpack1('v')] : [12, data[8, 4].unpack1('V')]
  header = data[at, size]
  shape = header[/'shape': \(([^)]*)\)/, 1].scan(/\d+/).map(&:to_i)
  plain = header.match?(/'descr': '\|[bu]1'/) && header.include?("'fortran_order': False")
  raise "#{path}: must be bytes or booleans with three axes" unless plain && shape.size == 3

  [shape, data[(at + size)..]]
end

# A bit a voxel, the least significant one first.
def mask_bits(bytes)
  [bytes.tr("^\0", '1').tr("\0", '0')].pack('b*')
end

def requests((depth, height, width), mask)
  bits = mask_bits(mask)
  extent = V1::LatticeExtent.new(nx: width, ny: height, nz: depth)
  volume = V1::VolumeDeclaration.new(encoding: :VOLUME_ENCODING_CUBIC_MASK, extent: extent,
                                     size_bytes: bits.bytesize)
  chunks = (0...bits.bytesize).step(CHUNK_BYTES).map do |offset|
    { chunk: V1::VolumeChunk.new(offset: offset, data: bits.byteslice(offset, CHUNK_BYTES)) }
  end
  finish = V1::VolumeFinish.new(size_bytes: bits.bytesize, sha256: Digest::SHA256.digest(bits))
  [{ config: V1::SkeletonizeConfig.new(volume: volume) }, *chunks, { finish: finish }]
    .map { |fields| V1::SkeletonizeRequest.new(**fields) }
end

# The nodes' kinds and the summary.
def skeletonize(address, shape, mask)
  stub = V1::SkeletonizationService::Stub.new(address, :this_channel_is_insecure, timeout: 600)
  kinds = []
  stub.skeletonize(requests(shape, mask)).each do |reply|
    kinds.concat(reply.skeleton_chunk.nodes&.kind.to_a) if reply.response == :skeleton_chunk
    return kinds, reply.summary if reply.response == :summary
  end
  raise 'the server ended the call without a summary'
end

path, address = ARGV
abort 'usage: skeletonize.rb MASK.npy [HOST:PORT]' if path.nil?
begin
  kinds, summary = skeletonize(address || '127.0.0.1:50051', *read_npy(path))
rescue GRPC::BadStatus => e
  abort "#{e.class.name.split('::').last}: #{e.details}"
end
puts "#{summary.object_points} points: #{kinds.count(:SKELETON_NODE_KIND_END)} ends, " \
     "#{summary.certificate.skeleton.loops} loops"
