// SPDX-License-Identifier: Apache-2.0
// node read_mcap.mjs FOLDER FILE: what the readers in FOLDER/node_modules find in an MCAP file, as JSON: the messages that the stream has
// from its beginning on, checksums compared, and those that the index finds.
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const [folder, file] = process.argv.slice(2);
const require = createRequire(path.resolve(folder, "package.json"));
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");

const bytes = new Uint8Array(fs.readFileSync(file));
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.slice(Number(offset), Number(offset + size)),
};
const plain = (key, value) => {
  if (typeof value === "bigint") return Number(value);
  return value instanceof Uint8Array ? Buffer.from(value).toString("base64") : value;
};

const stream = new McapStreamReader();
stream.append(bytes);
const records = [];
for (let record; (record = stream.nextRecord()) !== undefined; ) records.push(record);

const reader = await McapIndexedReader.Initialize({ readable });
const channels = [...reader.channelsById.values()];
const schemas = [...reader.schemasById.values()];
const text = new TextDecoder().decode(schemas[0].data);
const message_reader = new MessageReader(parse(text, { ros2: true }));
const indexed = [];
for await (const message of reader.readMessages()) {
  indexed.push({ ...message, decoded: message_reader.readMessage(message.data), bytes: message.data.length });
}
console.log(
  JSON.stringify(
    {
      done: stream.done(),
      types: records.map((record) => record.type),
      streamed: records.filter((record) => record.type === "Message"),
      data_crc: records.find((record) => record.type === "DataEnd").dataSectionCrc,
      summary_start: reader.footer.summaryStart,
      header: reader.header,
      statistics: reader.statistics && { ...reader.statistics, channelMessageCounts: [...reader.statistics.channelMessageCounts] },
      chunks: reader.chunkIndexes.length,
      offsets: reader.summaryOffsetsByOpcode && [...reader.summaryOffsetsByOpcode.keys()],
      channels: channels.map(({ topic, messageEncoding }) => ({ topic, messageEncoding })),
      schemas: schemas.map(({ name, encoding }) => ({ name, encoding })),
      indexed,
    },
    plain,
  ),
);
