//! The MCAP container, as much of it as a recording of one encounter needs: an indexed file with
//! compressed chunks, every checksum present. Same recording, same bytes. <https://mcap.dev/spec>
//!
//! Written here and not by the crate `mcap`, whose build costs more than this file is long
//! (docs/adr/0007); the end-to-end test reads the files with the format's own Python reader.

use serde_json::Value;
use std::collections::BTreeMap;

const MAGIC: [u8; 8] = [0x89, b'M', b'C', b'A', b'P', b'0', b'\r', b'\n'];
const COMPRESSION: &str = "zstd";
const COMPRESSION_LEVEL: i32 = 9;
/// Records of a chunk before it is closed, bytes.
const CHUNK_BYTES: usize = 1 << 20;

/// Operation codes of the records.
mod op {
    pub(super) const HEADER: u8 = 0x01;
    pub(super) const FOOTER: u8 = 0x02;
    pub(super) const SCHEMA: u8 = 0x03;
    pub(super) const CHANNEL: u8 = 0x04;
    pub(super) const MESSAGE: u8 = 0x05;
    pub(super) const CHUNK: u8 = 0x06;
    pub(super) const MESSAGE_INDEX: u8 = 0x07;
    pub(super) const CHUNK_INDEX: u8 = 0x08;
    pub(super) const STATISTICS: u8 = 0x0B;
    pub(super) const METADATA: u8 = 0x0C;
    pub(super) const METADATA_INDEX: u8 = 0x0D;
    pub(super) const SUMMARY_OFFSET: u8 = 0x0E;
    pub(super) const DATA_END: u8 = 0x0F;
}

/// A channel of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ChannelId(u16);

/// A schema of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SchemaId(u16);

#[derive(Debug)]
struct Message {
    channel: ChannelId,
    time_ns: u64,
    data: Vec<u8>,
}

/// What is to be written: JSON messages on channels, each with a JSON Schema.
#[derive(Debug, Default)]
pub(crate) struct Recording {
    schemas: Vec<Vec<u8>>,
    channels: Vec<Vec<u8>>,
    messages: Vec<Message>,
    metadata: Vec<(&'static str, String)>,
}

impl Recording {
    /// Adds a schema by the name that a viewer knows it by.
    pub(crate) fn schema(&mut self, name: &str, schema: &Value) -> SchemaId {
        let id = self.schemas.len() as u16 + 1;
        let mut body = Vec::new();
        body.extend(id.to_le_bytes());
        put_text(&mut body, name);
        put_text(&mut body, "jsonschema");
        put_text(&mut body, &schema.to_string());
        self.schemas.push(body);
        SchemaId(id)
    }

    pub(crate) fn channel(&mut self, topic: &str, schema: SchemaId) -> ChannelId {
        let id = self.channels.len() as u16 + 1;
        let mut body = Vec::new();
        body.extend(id.to_le_bytes());
        body.extend(schema.0.to_le_bytes());
        put_text(&mut body, topic);
        put_text(&mut body, "json");
        put_map(&mut body, &[]);
        self.channels.push(body);
        ChannelId(id)
    }

    /// A message at a time since the start of the encounter, nanoseconds.
    pub(crate) fn message(&mut self, channel: ChannelId, time_ns: u64, data: &Value) {
        self.messages.push(Message { channel, time_ns, data: data.to_string().into_bytes() });
    }

    /// A pair of the one metadata record.
    pub(crate) fn metadata(&mut self, key: &'static str, value: String) {
        self.metadata.push((key, value));
    }

    /// The file. Messages of equal time keep their order.
    ///
    /// # Errors
    /// The compression fails.
    pub(crate) fn finish(mut self, library: &str) -> std::io::Result<Vec<u8>> {
        self.messages.sort_by_key(|message| message.time_ns);
        let mut file = MAGIC.to_vec();
        let mut header = Vec::new();
        put_text(&mut header, "");
        put_text(&mut header, library);
        record(&mut file, op::HEADER, &header);
        for (operation, bodies) in [(op::SCHEMA, &self.schemas), (op::CHANNEL, &self.channels)] {
            bodies.iter().for_each(|body| record(&mut file, operation, body));
        }
        let metadata_index = self.write_metadata(&mut file);
        let chunk_indexes = self.write_chunks(&mut file)?;
        let crc = crc32fast::hash(&file);
        record(&mut file, op::DATA_END, &crc.to_le_bytes());
        let groups = [
            (op::SCHEMA, self.schemas.clone()),
            (op::CHANNEL, self.channels.clone()),
            (op::STATISTICS, vec![self.statistics(chunk_indexes.len())]),
            (op::CHUNK_INDEX, chunk_indexes),
            (op::METADATA_INDEX, vec![metadata_index]),
        ];
        write_summary(&mut file, &groups);
        file.extend(MAGIC);
        Ok(file)
    }

    /// The metadata record; returns its index.
    fn write_metadata(&self, file: &mut Vec<u8>) -> Vec<u8> {
        const NAME: &str = "seatrial";
        let start = file.len();
        let mut body = Vec::new();
        put_text(&mut body, NAME);
        put_map(&mut body, &self.metadata);
        record(file, op::METADATA, &body);
        let mut index = Vec::new();
        put_u64(&mut index, start);
        put_u64(&mut index, file.len() - start);
        put_text(&mut index, NAME);
        index
    }

    /// The chunks, each followed by the indexes of its channels; returns the indexes of the chunks.
    fn write_chunks(&self, file: &mut Vec<u8>) -> std::io::Result<Vec<Vec<u8>>> {
        let mut indexes = Vec::new();
        let mut chunk = Chunk::default();
        for (sequence, message) in self.messages.iter().enumerate() {
            chunk.push(sequence as u32, message);
            if chunk.records.len() >= CHUNK_BYTES {
                indexes.push(std::mem::take(&mut chunk).write(file)?);
            }
        }
        if !chunk.records.is_empty() {
            indexes.push(chunk.write(file)?);
        }
        Ok(indexes)
    }

    fn statistics(&self, chunks: usize) -> Vec<u8> {
        let mut counts: BTreeMap<ChannelId, u64> = BTreeMap::new();
        for message in &self.messages {
            *counts.entry(message.channel).or_default() += 1;
        }
        let time_ns = |message: Option<&Message>| message.map_or(0, |message| message.time_ns);
        let mut body = Vec::new();
        put_u64(&mut body, self.messages.len());
        body.extend((self.schemas.len() as u16).to_le_bytes());
        body.extend((self.channels.len() as u32).to_le_bytes());
        let (attachments, metadata) = (0_u32, 1_u32);
        body.extend(attachments.to_le_bytes());
        body.extend(metadata.to_le_bytes());
        body.extend((chunks as u32).to_le_bytes());
        body.extend(time_ns(self.messages.first()).to_le_bytes());
        body.extend(time_ns(self.messages.last()).to_le_bytes());
        put_length(&mut body, counts.len() * 10);
        for (channel, count) in counts {
            body.extend(channel.0.to_le_bytes());
            body.extend(count.to_le_bytes());
        }
        body
    }
}

#[derive(Debug, Default)]
struct Chunk {
    records: Vec<u8>,
    times_ns: Option<(u64, u64)>,
    /// Time and place of each message, by channel.
    places: BTreeMap<ChannelId, Vec<(u64, u64)>>,
}

impl Chunk {
    fn push(&mut self, sequence: u32, message: &Message) {
        let place = (message.time_ns, self.records.len() as u64);
        self.places.entry(message.channel).or_default().push(place);
        let first = self.times_ns.map_or(message.time_ns, |(first, _)| first);
        self.times_ns = Some((first, message.time_ns));
        let mut body = Vec::with_capacity(message.data.len() + 22);
        body.extend(message.channel.0.to_le_bytes());
        body.extend(sequence.to_le_bytes());
        body.extend(message.time_ns.to_le_bytes());
        body.extend(message.time_ns.to_le_bytes());
        body.extend(&message.data);
        record(&mut self.records, op::MESSAGE, &body);
    }

    /// Writes the chunk and the indexes of its messages; returns the index of the chunk.
    fn write(self, file: &mut Vec<u8>) -> std::io::Result<Vec<u8>> {
        let (first_ns, last_ns) = self.times_ns.unwrap_or_default();
        let packed = zstd::bulk::compress(&self.records, COMPRESSION_LEVEL)?;
        let start = file.len();
        let mut body = Vec::new();
        body.extend(first_ns.to_le_bytes());
        body.extend(last_ns.to_le_bytes());
        put_u64(&mut body, self.records.len());
        body.extend(crc32fast::hash(&self.records).to_le_bytes());
        put_text(&mut body, COMPRESSION);
        put_u64(&mut body, packed.len());
        body.extend(&packed);
        record(file, op::CHUNK, &body);
        let indexes_start = file.len();
        let mut offsets = Vec::new();
        for (channel, places) in &self.places {
            offsets.extend(channel.0.to_le_bytes());
            put_u64(&mut offsets, file.len());
            let mut body = channel.0.to_le_bytes().to_vec();
            put_length(&mut body, places.len() * 16);
            for (time_ns, at) in places {
                body.extend(time_ns.to_le_bytes());
                body.extend(at.to_le_bytes());
            }
            record(file, op::MESSAGE_INDEX, &body);
        }
        let mut index = Vec::new();
        index.extend(first_ns.to_le_bytes());
        index.extend(last_ns.to_le_bytes());
        put_u64(&mut index, start);
        put_u64(&mut index, indexes_start - start);
        put_length(&mut index, offsets.len());
        index.extend(offsets);
        put_u64(&mut index, file.len() - indexes_start);
        put_text(&mut index, COMPRESSION);
        put_u64(&mut index, packed.len());
        put_u64(&mut index, self.records.len());
        Ok(index)
    }
}

/// Summary, summary offsets and footer. Empty groups leave no trace.
fn write_summary(file: &mut Vec<u8>, groups: &[(u8, Vec<Vec<u8>>)]) {
    let summary_start = file.len();
    let mut offsets = Vec::new();
    for (operation, bodies) in groups.iter().filter(|(_, bodies)| !bodies.is_empty()) {
        let start = file.len();
        bodies.iter().for_each(|body| record(file, *operation, body));
        let mut offset = vec![*operation];
        put_u64(&mut offset, start);
        put_u64(&mut offset, file.len() - start);
        offsets.push(offset);
    }
    let offsets_start = file.len();
    offsets.iter().for_each(|offset| record(file, op::SUMMARY_OFFSET, offset));
    // the checksum covers the footer's own beginning
    const FOOTER_BYTES: u64 = 8 + 8 + 4;
    file.push(op::FOOTER);
    file.extend(FOOTER_BYTES.to_le_bytes());
    put_u64(file, summary_start);
    put_u64(file, offsets_start);
    let crc = crc32fast::hash(&file[summary_start..]);
    file.extend(crc.to_le_bytes());
}

fn record(file: &mut Vec<u8>, operation: u8, body: &[u8]) {
    file.push(operation);
    put_u64(file, body.len());
    file.extend(body);
}

fn put_u64(bytes: &mut Vec<u8>, value: usize) {
    bytes.extend((value as u64).to_le_bytes());
}

fn put_length(bytes: &mut Vec<u8>, length: usize) {
    bytes.extend((length as u32).to_le_bytes());
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    put_length(bytes, text.len());
    bytes.extend(text.as_bytes());
}

fn put_map(bytes: &mut Vec<u8>, pairs: &[(&str, String)]) {
    let mut body = Vec::new();
    for (key, value) in pairs {
        put_text(&mut body, key);
        put_text(&mut body, value);
    }
    put_length(bytes, body.len());
    bytes.extend(body);
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Operation code and body of every record between the magics.
    fn records(file: &[u8]) -> Vec<(u8, &[u8])> {
        assert_eq!((&file[..8], &file[file.len() - 8..]), (&MAGIC[..], &MAGIC[..]));
        let mut rest = &file[8..file.len() - 8];
        let mut found = Vec::new();
        while let Some((&operation, tail)) = rest.split_first() {
            let length = u64::from_le_bytes(tail[..8].try_into().unwrap()) as usize;
            found.push((operation, &tail[8..8 + length]));
            rest = &tail[8 + length..];
        }
        found
    }

    fn u64_at(bytes: &[u8], at: usize) -> usize {
        u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize
    }

    fn recording(messages: u64) -> Vec<u8> {
        let mut recording = Recording::default();
        let schema = recording.schema("test.Number", &json!({ "type": "object" }));
        let channels = ["/a", "/b"].map(|topic| recording.channel(topic, schema));
        recording.metadata("encounter", "head_on/000001".to_owned());
        // written out of order, so that the file has to sort
        for t in (0..messages).rev() {
            for channel in channels {
                let filler = "x".repeat(1000);
                recording.message(channel, t * 1_000, &json!({ "t": t, "filler": filler }));
            }
        }
        recording.finish("test").unwrap()
    }

    #[test]
    fn every_offset_points_at_what_it_names_and_every_message_is_found() {
        let file = recording(700);
        let all = records(&file);
        let operation_at = |offset: usize| file[offset];
        let (_, footer) = all.last().unwrap();
        let (summary, offsets) = (u64_at(footer, 0), u64_at(footer, 8));
        assert_eq!(operation_at(summary), op::SCHEMA);
        assert_eq!(operation_at(offsets), op::SUMMARY_OFFSET);
        let groups: Vec<u8> =
            all.iter().filter(|r| r.0 == op::SUMMARY_OFFSET).map(|r| r.1[0]).collect();
        let wanted = [op::SCHEMA, op::CHANNEL, op::STATISTICS, op::CHUNK_INDEX, op::METADATA_INDEX];
        assert_eq!(groups, wanted);
        for (_, body) in all.iter().filter(|r| r.0 == op::SUMMARY_OFFSET) {
            assert_eq!(operation_at(u64_at(body, 1)), body[0]);
        }
        let chunks: Vec<&[u8]> = all.iter().filter(|r| r.0 == op::CHUNK).map(|r| r.1).collect();
        assert!(chunks.len() > 1, "{}", chunks.len());
        let mut messages = 0;
        let mut last_ns = 0;
        for (chunk, (_, index)) in chunks.iter().zip(all.iter().filter(|r| r.0 == op::CHUNK_INDEX))
        {
            assert_eq!(operation_at(u64_at(index, 16)), op::CHUNK);
            let unpacked =
                zstd::bulk::decompress(&chunk[8 + 8 + 8 + 4 + 8 + 8..], 4 << 20).unwrap();
            assert_eq!(unpacked.len(), u64_at(chunk, 16));
            assert_eq!(crc32fast::hash(&unpacked).to_le_bytes(), chunk[24..28]);
            let framed = [&MAGIC[..], &unpacked, &MAGIC[..]].concat();
            for (operation, message) in records(&framed) {
                assert_eq!(operation, op::MESSAGE);
                assert!(u64_at(message, 6) >= last_ns);
                last_ns = u64_at(message, 6);
                messages += 1;
            }
        }
        assert_eq!((messages, last_ns), (1400, 699_000));
        let statistics = all.iter().find(|r| r.0 == op::STATISTICS).unwrap().1;
        assert_eq!(u64_at(statistics, 0), 1400);
    }

    #[test]
    fn the_same_recording_gives_the_same_bytes_and_an_empty_one_is_a_file() {
        assert_eq!(recording(20), recording(20));
        assert_ne!(recording(20), recording(21));
        let empty = Recording::default().finish("test").unwrap();
        assert_eq!(records(&empty).last().unwrap().0, op::FOOTER);
    }
}
